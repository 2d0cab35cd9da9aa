//! The history of quantities at one point of space, as a text file of columns.

use super::points::{REQUIRED, points_output, position};
use crate::diagnostics::Result;
use crate::parameters::Defaults;
use crate::processes::{Process, ProcessEntry, ProcessRequest};
use crate::register;

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(|defaults: Defaults| defaults.require(&REQUIRED).require(&["position"]))?;
    let point = position(&settings, "position", settings.get("position")?)?;
    points_output(request, &settings, "position", &[point], false)
}

register! { ProcessEntry "point_output_process",
    aliases: &["PointOutputProcess"],
    about: "writes the history of quantities at one point of space, a line a step",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/point_output_process.json")),
    build: build,
}
