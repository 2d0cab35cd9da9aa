//! The histories of quantities at points along a line, a text file of columns each.

use super::points::{REQUIRED, points_output, position};
use crate::diagnostics::Result;
use crate::parameters::Defaults;
use crate::processes::{Process, ProcessEntry, ProcessRequest};
use crate::register;

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let ends = ["start_point", "end_point"];
    let settings = request.settings_with(|defaults: Defaults| defaults.require(&REQUIRED).require(&ends))?;
    let [start, end] = ends.map(|key| settings.get(key).and_then(|node| position(&settings, key, node)));
    let (start, end) = (start?, end?);
    let count = settings.get_usize("sampling_points")?;
    let along = |share: f64| std::array::from_fn(|axis| start[axis] + share * (end[axis] - start[axis]));
    let points: Vec<[f64; 3]> = match count {
        1 => vec![along(0.5)],
        _ => (0..count).map(|at| along(at as f64 / (count - 1) as f64)).collect(),
    };
    points_output(request, &settings, "start_point", &points, true)
}

register! { ProcessEntry "line_output_process",
    aliases: &["LineOutputProcess"],
    about: "writes the histories of quantities at points along a line, a file each, a line a step",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/line_output_process.json")),
    build: build,
}
