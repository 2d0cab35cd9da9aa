//! One linear solve of an iteration: the equations, corrected for the small tangents of follower loads.

use zelus_linear_algebra::{Csr, LinearSolver, SolveError, SolveReport, System, vector};

use super::condensing;
use super::distributed_rows::{DistributedRows, SystemShare};
use super::dof_name::{DofName, DofNames};
use super::location::{body_of, location};
use super::root_gather::RootGather;
use crate::assembly::{Assembler, DofTable, WholeSystem};
use crate::diagnostics::Error;
use crate::model::{ModelPart, Nodes};

/// Corrections for the load tangents before they are merged into the bulk.
const CORRECTIONS: usize = 12;
/// Residual relative to the right-hand side at which corrections stop.
const ACCURACY: f64 = 1e-10;

/// Result of a linear solve.
pub(super) struct Solved {
    /// Increment of the equations.
    pub increment: Vec<f64>,
    /// Norm of the residual over that of the right-hand side.
    pub relative_residual: f64,
    /// Krylov iterations, or steps of refinement.
    pub iterations: usize,
    /// Who solved.
    pub engine: String,
    /// Why another engine than the one asked for solved.
    pub fallback: Option<String>,
}

/// Why there is no increment.
pub(super) enum Failed {
    /// The matrix is singular, which another state of the interactions may mend; with ids of nodes that seem free.
    Singular(String, Vec<usize>),
    /// The matrix is so nearly singular that the direct engine finds no increment.
    Inaccurate(String),
    /// Anything else.
    Other(Error),
}

impl Failed {
    /// The same; a singular system also names nodes that seem free, one of each part. Collective.
    pub(super) fn in_part(self, part: &ModelPart) -> Self {
        let Self::Singular(why, ids) = self else { return self };
        let mut bodies: Vec<Option<&str>> = Vec::new();
        let mut places = Vec::new();
        for node in ids.iter().filter_map(|&id| part.nodes.find(id)).filter(|&node| part.owns_node(node as usize)) {
            let body = body_of(&part.tree, node);
            if !bodies.contains(&body) {
                bodies.push(body);
                places.push(format!("node {}{}", part.nodes.ids[node as usize], location(part, node)));
            }
        }
        let places = part.ranks.lines_of_all(places).join(", ");
        let why = match why.split_once('\n') {
            Some((fact, remedy)) if !places.is_empty() => format!("{fact}; what moves is at {places}\n{remedy}"),
            _ => why,
        };
        Self::Singular(why, ids)
    }
}

impl From<Failed> for Error {
    fn from(failed: Failed) -> Self {
        match failed {
            Failed::Singular(why, _) | Failed::Inaccurate(why) => Self::System(why),
            Failed::Other(error) => error,
        }
    }
}

impl From<Error> for Failed {
    fn from(error: Error) -> Self {
        Self::Other(error)
    }
}

/// Solves for the increment of the equations; on several ranks, rank 0 solves for all of them, with the
/// threads of those that wait beside it.
///
/// # Errors
/// A singular matrix or a solver that fails, naming nodes.
pub(super) fn solve(
    assembler: &mut Assembler,
    solver: &mut dyn LinearSolver,
    root_gather: &mut RootGather,
    rhs: &[f64],
    dofs: &DofTable,
    nodes: &Nodes,
) -> Result<(Vec<f64>, SolveReport), Failed> {
    let is_here = assembler.numbering().is_none();
    if is_here && assembler.has_whole() && solver.takes_inactive_rows(assembler.equations().len(), assembler.entries())
    {
        let (rhs, merged) = (assembler.equations().expand(rhs), assembler.merged_values());
        let dof_name = |number: usize| Some(DofName::of(dofs, nodes, number as u32));
        let (increment, report) =
            assembler.with_whole(|_, whole| solve_here(&whole.system, whole.loads, merged, solver, &rhs, &dof_name))?;
        return Ok((assembler.equations().reduce(&increment), report));
    }
    if is_here {
        assembler.reduce();
        let (loads, system) = (assembler.load_tangents().cloned(), assembler.system());
        let unknowns = assembler.equations().unknowns();
        let dof_name = |equation: usize| unknowns.get(equation).map(|&number| DofName::of(dofs, nodes, number));
        return solve_here(&system, loads.as_ref(), assembler.merged_values(), solver, rhs, &dof_name);
    }
    let mut why = None;
    if !root_gather.has_petsc() && is_shared(assembler, solver) {
        match solve_shared(assembler, solver, &mut root_gather.shared, rhs, dofs, nodes) {
            Ok((own, report)) => return Ok((assembler.complete(&own), report)),
            Err(error) => why = Some(format!("over all ranks: {error}")),
        }
    }
    assembler.reduce();
    let (loads, system) = (assembler.load_tangents().cloned(), assembler.system());
    let (numbering, ranks) = (assembler.numbering().expect("several ranks"), assembler.ranks());
    #[cfg(feature = "petsc")]
    if let Some(rows) = &mut root_gather.petsc {
        let solved = rows.solve(assembler, numbering, loads.as_ref(), dofs, nodes, rhs)?;
        return solved.map_err(|error| explain(&error, None, &|equation| rows.dof_name(equation)));
    }
    root_gather.update(assembler, loads.as_ref(), dofs, nodes);
    let rhs = root_gather.gather(ranks, rhs, numbering);
    let (whole, loads) = root_gather.system(&system);
    let solved = if ranks.is_root() {
        let merged = assembler.merged_values();
        let dof_names = root_gather.dof_names();
        root_gather.while_others_wait(|| {
            solve_here(&whole, loads, merged, solver, &rhs, &|equation| dof_names.get(equation).copied())
        })
    } else {
        Ok((Vec::new(), elsewhere()))
    };
    let singular = match &solved {
        Err(Failed::Singular(why, ids)) => (Some(why.clone()), ids.iter().map(|&id| id as f64).collect()),
        _ => (None, Vec::new()),
    };
    if let Some(why) = ranks.first_to_say(singular.0) {
        let ids = ranks.gather_numbers(&singular.1).concat();
        return Err(Failed::Singular(why, ids.into_iter().map(|id| id as usize).collect()));
    }
    let (increment, mut report) = ranks.agree(solved.map_err(Error::from))?;
    let reasons = [why, report.fallback.take()];
    report.fallback = reasons.into_iter().flatten().reduce(|first, then| first + "; " + &then);
    Ok((assembler.complete(&root_gather.scatter(ranks, &increment, numbering)), report))
}

/// Whether `solver` works where the rows are, on all ranks or on none; collective.
fn is_shared(assembler: &Assembler, solver: &dyn LinearSolver) -> bool {
    let (ranks, numbering) = (assembler.ranks(), assembler.numbering().expect("several ranks"));
    let entries = ranks.total(assembler.entries() as f64);
    let equations = numbering.starts[ranks.size()];
    !ranks.any(!solver.shares(equations, entries as usize))
}

/// Solves where the rows are; gives the increments of own equations. Collective.
fn solve_shared(
    assembler: &mut Assembler,
    solver: &mut dyn LinearSolver,
    shared: &mut DistributedRows,
    rhs: &[f64],
    dofs: &DofTable,
    nodes: &Nodes,
) -> Result<(Vec<f64>, SolveReport), SolveError> {
    let mut solve = |share: SystemShare<'_>, rhs: &[f64]| {
        shared.update(&share, dofs, nodes);
        let own = shared.of_own(share.numbering, rhs);
        let mut increment = vec![0.0; own.len()];
        let report = solver.solve(&shared.system(&share.system), &own, &mut increment)?;
        Ok((share.numbering.own_of(&increment), report))
    };
    if assembler.has_whole() {
        let rhs = assembler.equations().expand(rhs);
        return assembler.with_whole(|assembler, WholeSystem { system, loads }| {
            let numbering = assembler.whole_numbering().expect("no unknown follows others");
            solve(SystemShare { ranks: assembler.ranks(), numbering, system, loads, unknowns: None }, &rhs)
        });
    }
    assembler.reduce();
    let loads = assembler.load_tangents().cloned();
    let share = SystemShare {
        ranks: assembler.ranks(),
        numbering: assembler.numbering().expect("several ranks"),
        system: assembler.system(),
        loads: loads.as_ref(),
        unknowns: Some(assembler.equations().unknowns()),
    };
    solve(share, rhs)
}

/// Report on a rank other than 0 of a solve that rank 0 did.
fn elsewhere() -> SolveReport {
    SolveReport {
        engine: "rank 0",
        relative_residual: 0.0,
        iterations: 0,
        fallback: None,
        seconds_symbolic: 0.0,
        seconds_numeric: 0.0,
        seconds_solve: 0.0,
    }
}

/// Solves for the increment of the equations of `system`.
///
/// Follower loads make the tangent slightly unsymmetric. Engines that do not mind take them with the coupling. For others the
/// factorised rest serves as the preconditioner of a stationary
/// iteration; when their tangents are too large for it, they are merged into the matrix, whose values then have the stamp `merged`.
fn solve_here(
    system: &System<'_>,
    loads: Option<&Csr>,
    merged: u64,
    solver: &mut dyn LinearSolver,
    rhs: &[f64],
    dof_name: DofNames<'_>,
) -> Result<(Vec<f64>, SolveReport), Failed> {
    let explain = |error: SolveError| explain(&error, Some(system), dof_name);
    let mut increment = vec![0.0; rhs.len()];
    if let Some(loads) = loads
        && solver.takes_loads(system)
    {
        let coupling = system.coupling.map_or_else(|| loads.clone(), |coupling| coupling.plus(loads));
        let whole = System {
            coupling: Some(&coupling),
            coupling_graph: u64::MAX - system.bulk_graph,
            coupling_values: merged,
            coupling_symmetric: false,
            ..*system
        };
        let report = solver.solve(&whole, rhs, &mut increment).map_err(explain)?;
        return Ok((increment, report));
    }
    let mut report = solver.solve(system, rhs, &mut increment).map_err(explain)?;
    let Some(loads) = loads else { return Ok((increment, report)) };
    let scale = vector::norm(rhs);
    let mut residual = vec![0.0; rhs.len()];
    let mut correction = vec![0.0; rhs.len()];
    let mut last = f64::INFINITY;
    for _ in 0..CORRECTIONS {
        system.residual(rhs, &increment, &mut residual);
        loads.mul_vec_subtract(&increment, &mut residual);
        system.clear_inactive(&mut residual);
        let size = vector::norm(&residual);
        report.relative_residual = if scale > 0.0 { size / scale } else { 0.0 };
        if report.relative_residual <= ACCURACY {
            return Ok((increment, report));
        }
        if size > 0.5 * last {
            break;
        }
        last = size;
        correction.fill(0.0);
        let again = solver.solve(system, &residual, &mut correction).map_err(explain)?;
        report.add_effort(&again);
        vector::add_scaled(1.0, &correction, &mut increment);
    }
    if report.relative_residual <= 1e-6 {
        return Ok((increment, report));
    }
    let bulk: Csr = system.bulk.plus(loads);
    let whole = System {
        bulk: &bulk,
        bulk_symmetry: zelus_linear_algebra::Symmetry::General,
        bulk_graph: u64::MAX - system.bulk_graph,
        bulk_values: merged,
        ..*system
    };
    increment.fill(0.0);
    let mut merged = solver.solve(&whole, rhs, &mut increment).map_err(explain)?;
    merged.add_effort(&report);
    Ok((increment, merged))
}

fn explain(error: &SolveError, system: Option<&System<'_>>, dof_name: DofNames<'_>) -> Failed {
    if let SolveError::NotCondensable(refused) = error {
        let (fact, remedy) = (condensing::fact(*refused, dof_name), condensing::remedy(*refused));
        return Failed::Other(Error::System(format!("linear solve: {fact}\n    {remedy}")));
    }
    if let SolveError::NotConverged { engine: "direct", .. } = error {
        return Failed::Inaccurate(format!("linear solve: {error}: the system of equations is nearly singular"));
    }
    let SolveError::Singular { equations, rank_deficiency } = error else {
        return Failed::Other(Error::System(format!("linear solve: {error}")));
    };
    let names: Vec<String> =
        equations.iter().take(6).filter_map(|&e| dof_name(e)).map(|dof_name| dof_name.to_string()).collect();
    let only_multipliers = equations.iter().all(|&e| dof_name(e).is_some_and(|dof_name| dof_name.multiplier));
    let rank = match rank_deficiency {
        _ if only_multipliers => system.and_then(|system| {
            let rank = zelus_linear_algebra::rank(system)?;
            Some(format!(": its rank is {rank}, its size {}", system.free()))
        }),
        free => free.map(|r| format!(", at least {r} free motions")),
    }
    .unwrap_or_default();
    let remedy = if only_multipliers {
        "the model is over-constrained, or a constraint has no active equation: remove constraints, or impose them by \
         a penalty"
    } else {
        "some body can move freely: support it, or check that contact holds it from the first step"
    };
    let free = equations.iter().filter_map(|&e| dof_name(e)).filter(|dof_name| !dof_name.multiplier);
    Failed::Singular(
        format!("the system of equations is singular{rank}; suspicious: {}\n    {remedy}", names.join(", ")),
        free.map(|dof_name| dof_name.node).collect(),
    )
}
