//! Results of a run, as other formats take them up: all steps with their times.

use std::path::Path;

use zelus_core::diagnostics::{Diagnostic, Place, Result};
use zelus_core::io::results::{Dataset, read_pvd, read_vtu};

/// The steps of a series (`.pvd`), or the one of a file (`.vtu`, `.pvtu`), with their times.
///
/// # Errors
/// A file that is missing, damaged or not of this program; a series of none.
pub(crate) fn read_series(from: &Path) -> Result<(Vec<f64>, Vec<Dataset>)> {
    let is_series = from.extension().is_some_and(|ending| ending == "pvd");
    let files = if is_series { read_pvd(from)? } else { vec![(0.0, from.to_owned())] };
    if files.is_empty() {
        let problem = Diagnostic::error("no-steps", "the series names no file").at(Place::file(from));
        return Err(problem.remedy("give a .pvd that a run has written").into());
    }
    let times = files.iter().map(|(time, _)| *time).collect();
    let steps = files.iter().map(|(_, file)| read_vtu(file)).collect::<Result<Vec<_>>>()?;
    Ok((times, steps))
}

/// For each step the step whose mesh it has: itself, or an earlier one where the mesh has not changed since.
pub(crate) fn meshes(steps: &[Dataset]) -> Vec<usize> {
    let mut out: Vec<usize> = Vec::new();
    for (at, step) in steps.iter().enumerate() {
        let last = at.checked_sub(1).map(|before| out[before]);
        let same = last.filter(|&last| steps[last].points == step.points && steps[last].cells == step.cells);
        out.push(same.unwrap_or(at));
    }
    out
}
