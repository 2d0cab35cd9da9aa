//! Axes of the material that are the same in all elements of a part.

use zelus_core::diagnostics::Result;
use zelus_core::parameters::Settings;
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest};
use zelus_core::register;

use super::local_axes::LocalAxes;
use crate::laws::axes_of_element;

const AXES: &str = "cartesian_local_axis";

/// Two axes, or in the plane one.
///
/// # Errors
/// Another number of axes.
fn axes_of(settings: &Settings, planar: bool) -> Result<[[f64; 3]; 2]> {
    let given = settings.items(AXES)?;
    let one = given.iter().all(|item| item.as_f64().is_some());
    let axes: Vec<[f64; 3]> =
        if one { vec![settings.get(AXES)?.parse(AXES)?] } else { settings.get(AXES)?.parse(AXES)? };
    match axes[..] {
        [first] if planar => Ok([first, [0.0; 3]]),
        [first, second] => Ok([first, second]),
        _ => {
            let problem = settings.error(AXES, "invalid-value", format!("\"{AXES}\" has {} axes", axes.len()));
            let remedy = if planar {
                "write one axis, [1.0, 0.0, 0.0]"
            } else {
                "write two axes, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]"
            };
            Err(problem.remedy(remedy).into())
        }
    }
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(|defaults| defaults.require(&["model_part_name"]))?;
    let planar = request.model.root(settings.get_str("model_part_name")?)?.info.domain_size == 2;
    if settings.get_i64("set_local_axes_direction")? != -1 {
        let problem = settings.error("set_local_axes_direction", "invalid-value", "one axis alone is asked for");
        return Err(problem.remedy("write -1: solids need all their axes").into());
    }
    let [first, second] = axes_of(&settings, planar)?;
    let sound = match axes_of_element(first, second, planar) {
        Ok(Some(_)) => Ok(()),
        Ok(None) => Err("axis 1 has no length"),
        Err("its LOCAL_AXIS_1 is not in the plane") => Err("axis 1 is not in the plane"),
        Err("its LOCAL_AXIS_1 and LOCAL_AXIS_2 are not perpendicular") => Err("axes 1 and 2 are not perpendicular"),
        Err(_) => Err("an axis has no length"),
    };
    if let Err(fact) = sound {
        let problem = settings.error(AXES, "material-axes", format!("\"{AXES}\": {fact}"));
        return Err(problem.remedy("write perpendicular axes, e.g. [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]").into());
    }
    LocalAxes::boxed(&settings, request.model, Box::new(move |_| Ok([first, second])))
}

register! { ProcessEntry "set_cartesian_local_axes_process",
    aliases: &["SetCartesianLocalAxesProcess"],
    about: "axes of the material that are the same in all elements of a part",
    source: "LOCAL_AXIS_1 and LOCAL_AXIS_2 as written",
    common: &["model_part_name", "cartesian_local_axis"],
    defaults: include_str!("../../../../configs/processes/set_cartesian_local_axes_process.json"),
    build: build,
}
