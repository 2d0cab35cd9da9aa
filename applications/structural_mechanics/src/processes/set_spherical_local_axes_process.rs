//! Axes of the material about a point: axis 1 points away from it, axis 2 around the reference axis.

use zelus_core::diagnostics::Result;
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest};
use zelus_core::register;

use super::local_axes::{LocalAxes, direction, point};

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(|defaults| defaults.require(&["model_part_name"]))?;
    let reference = direction(&settings, "spherical_reference_axis")?;
    let centre = point(&settings, "spherical_central_point")?;
    let planar = request.model.root(settings.get_str("model_part_name")?)?.info.domain_size == 2;
    let axes = move |x: [f64; 3]| {
        let from_centre = nalgebra::Vector3::from(x) - centre;
        let Some(radial) = from_centre.try_normalize(0.0) else { return Err("its centre is the central point") };
        match radial.cross(&reference).try_normalize(1e-12) {
            Some(around) => Ok([radial.into(), around.into()]),
            None if planar => Ok([radial.into(), [0.0; 3]]),
            None => Err("its centre lies on the reference axis"),
        }
    };
    LocalAxes::boxed(&settings, request.model, Box::new(axes))
}

register! { ProcessEntry "set_spherical_local_axes_process",
    aliases: &["SetSphericalLocalAxesProcess"],
    about: "axes of the material about a point: axis 1 radial, axis 2 around the reference axis",
    source: "a_1 = (x − x_0)/|x − x_0|, a_2 = a_1 × e/|a_1 × e| with the reference axis e",
    common: &["model_part_name", "spherical_reference_axis", "spherical_central_point"],
    defaults: include_str!("../../../../configs/processes/set_spherical_local_axes_process.json"),
    build: build,
}
