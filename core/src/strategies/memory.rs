//! Whether a run fits in memory, asked before it starts: the one place that decides.
//!
//! The check compares the matrices that will be assembled and the solver's own need ([`LinearSolver::needs`]) with the memory that the
//! machine has free ([`memory::available`]) or that the deck allows (`"memory_limit"` of `linear_solver_settings`, in GB). Runs on
//! several ranks are not judged: the memory of each rank is not known before.

use zelus_linear_algebra::{LinearSolver, memory};

use crate::communication::Ranks;
use crate::diagnostics::{Diagnostic, Result};
use crate::parameters::Settings;

/// Bytes of an entry of the matrix over all unknowns, whose rows share the columns of their node, and of the one over the equations.
const ASSEMBLED: [u64; 2] = [10, 12];
const GIGABYTE: f64 = 1e9;

/// The size of a system: unknowns, and entries of its matrix.
#[derive(Debug, Clone, Copy)]
pub(super) struct Size {
    pub unknowns: usize,
    pub entries: usize,
    /// Whether unknowns follow others, so that the equations have a matrix of their own whoever solves.
    pub reduced: bool,
}

impl Size {
    fn needed(self, solver: &dyn LinearSolver) -> u64 {
        let [whole, reduced] = ASSEMBLED;
        let is_one = !self.reduced && solver.takes_inactive_rows(self.unknowns, self.entries);
        let assembled = if is_one { whole } else { whole + reduced };
        self.entries as u64 * assembled + solver.needs(self.unknowns, self.entries)
    }
}

/// `solver` where it fits; else `frugal` with a warning that says so.
///
/// # Errors
/// Neither fits, or a limit that is no number above zero.
pub(super) fn fitting(
    ranks: &Ranks,
    solver: Box<dyn LinearSolver>,
    frugal: Option<Box<dyn LinearSolver>>,
    size: Size,
    settings: &Settings,
) -> Result<(Box<dyn LinearSolver>, Option<Diagnostic>)> {
    let limit = match settings.node().get("memory_limit") {
        None => None,
        Some(node) => match node.f64()? {
            gigabytes if gigabytes > 0.0 => Some((gigabytes * GIGABYTE) as u64),
            gigabytes => {
                let fact = format!("\"memory_limit\" is {gigabytes}");
                let problem = settings.error("memory_limit", "invalid-value", fact);
                return Err(problem.remedy("write gigabytes above 0").into());
            }
        },
    };
    if ranks.size() > 1 {
        return Ok((solver, None));
    }
    let Some(free) = limit.into_iter().chain(memory::available()).min() else { return Ok((solver, None)) };
    let wanted = size.needed(solver.as_ref());
    if wanted <= free {
        return Ok((solver, None));
    }
    let gigabytes = |bytes: u64| format!("{:.3} GB", bytes as f64 / GIGABYTE);
    let fact = format!(
        "{} unknowns with {} entries of the matrix take about {} with the engine {}, and {} are free",
        size.unknowns,
        size.entries,
        gigabytes(wanted),
        solver.name(),
        gigabytes(free)
    );
    let place = settings.key_place("memory_limit");
    let least = frugal.as_ref().map(|frugal| size.needed(frugal.as_ref()));
    match (frugal, least) {
        (Some(frugal), Some(least)) if least <= free => {
            let remedy =
                format!("{} solves, in about {}; or give the run more memory", frugal.name(), gigabytes(least));
            Ok((frugal, Some(Diagnostic::warning("memory", fact).at(place).remedy(remedy))))
        }
        _ => {
            let more = "give the run more memory, coarsen the mesh, or use more machines (feature \"petsc\")";
            let remedy =
                least.map_or(more.to_owned(), |least| format!("the least is about {}: {more}", gigabytes(least)));
            Err(Diagnostic::error("memory", fact).at(place).remedy(remedy).into())
        }
    }
}
