//! The histories of quantities at several points of space, a text file of columns each.

use super::points::{REQUIRED, points_output, position};
use crate::diagnostics::Result;
use crate::parameters::{Defaults, Node};
use crate::processes::{Process, ProcessEntry, ProcessRequest};
use crate::register;

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(|defaults: Defaults| defaults.require(&REQUIRED).require(&["positions"]))?;
    let rows = settings.items("positions")?;
    let points = rows.iter().map(|row: &Node| position(&settings, "positions", row)).collect::<Result<Vec<_>>>()?;
    if points.is_empty() {
        return Err(settings.error("positions", "wrong-size", "\"positions\" has no point").into());
    }
    points_output(request, &settings, "positions", &points, true)
}

register! { ProcessEntry "multiple_points_output_process",
    aliases: &["MultiplePointsOutputProcess"],
    about: "writes the histories of quantities at several points of space, a file each, a line a step",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/multiple_points_output_process.json")),
    build: build,
}
