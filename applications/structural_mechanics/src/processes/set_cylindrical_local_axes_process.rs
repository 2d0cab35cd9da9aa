//! Axes of the material about a line: axis 1 points away from it, axis 2 along it, in the plane around it.

use zelus_core::diagnostics::Result;
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest};
use zelus_core::register;

use super::local_axes::{LocalAxes, direction, point};

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(|defaults| defaults.require(&["model_part_name"]))?;
    let along = direction(&settings, "cylindrical_generatrix_axis")?;
    let origin = point(&settings, "cylindrical_generatrix_point")?;
    let axes = move |x: [f64; 3]| {
        let from_origin = nalgebra::Vector3::from(x) - origin;
        let size = from_origin.norm();
        let radial = from_origin - from_origin.dot(&along) * along;
        let Some(radial) = radial.try_normalize(1e-12 * size) else { return Err("its centre lies on the line") };
        Ok([radial.into(), along.into()])
    };
    LocalAxes::boxed(&settings, request.model, Box::new(axes))
}

register! { ProcessEntry "set_cylindrical_local_axes_process",
    aliases: &["SetCylindricalLocalAxesProcess"],
    about: "axes of the material about a line: axis 1 radial, axis 2 along the line (in the plane around it)",
    source: "a_1 = (x − x_line)/|x − x_line|, a_2 = the direction of the line",
    common: &["model_part_name", "cylindrical_generatrix_axis", "cylindrical_generatrix_point"],
    defaults: include_str!("../../../../configs/processes/set_cylindrical_local_axes_process.json"),
    build: build,
}
