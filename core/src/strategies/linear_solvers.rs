//! The linear solvers that decks name, and the engine that serves each.

use zelus_linear_algebra::{
    DirectSettings, Engine, KrylovSettings, LinearSolver, MultigridSettings, Multipliers, Preconditioner, create,
};

use crate::assembly::System;
use crate::diagnostics::Result;
use crate::model::ModelPart;
use crate::parameters::{Node, Range, Settings};
use crate::{register, registered_kind, registry};

/// Arguments from which a linear solver is made.
pub struct LinearSolverRequest<'a> {
    /// `linear_solver_settings` of the deck.
    pub settings: &'a Settings,
    /// Treatment of multipliers by iterative engines.
    pub multipliers: Multipliers,
    /// Relative residual below which an answer gains the iteration around it nothing.
    pub tolerance: f64,
}

/// Makes a linear solver.
pub type LinearSolverFactory = fn(&LinearSolverRequest<'_>) -> Result<Box<dyn LinearSolver>>;

registered_kind! {
    /// A preconditioner that `preconditioner_type` names, for conjugate gradients and GMRES.
    pub struct PreconditionerEntry("preconditioner", "unknown-name") {
        build: Preconditioner;
    }
}

registered_kind! {
    /// A linear solver that decks name.
    pub struct LinearSolverEntry("linear_solver", "unknown-linear-solver") {
        build: LinearSolverFactory;
    }
}

/// Factor of the residual's tolerance for an iterative engine, and the bounds of the result.
const LEFT: f64 = 0.1;
const TOLERANCES: [f64; 2] = [1e-10, 1e-7];

/// Relative residual that an iterative engine may leave where an iteration around it needs less, if the deck names none.
const LOOSEST: f64 = 1e-3;

/// Relative residual to ask of an iterative engine in an iteration that ends at `residual`: each then gains seven digits.
pub(crate) fn tolerance(residual: f64) -> f64 {
    (LEFT * residual).clamp(TOLERANCES[0], TOLERANCES[1])
}

/// Numbers of `linear_solver_settings`, with their ranges; that of the tolerance is checked with all tolerances.
const NUMBERS: [(&str, &str); 3] =
    [("tolerance", "(-inf, inf)"), ("max_iteration", "[1, inf)"), ("direct_below", "[0, inf)")];

/// The solver for `linear_solver_settings`, and a sentence that names the engine.
///
/// # Errors
/// An unknown name, `wrong-type` and `out-of-range` for numbers.
pub(crate) fn make(request: &LinearSolverRequest<'_>) -> Result<(Box<dyn LinearSolver>, String)> {
    let settings = request.settings;
    for (key, range) in NUMBERS {
        let Some(given) = settings.node().get(key) else { continue };
        given.f64()?;
        let range = Range::parse(range).expect("an interval");
        if let Some(problem) = range.problem(given, &format!("{key:?} of \"linear_solver_settings\"")) {
            return Err(problem.remedy("take it out for the default").into());
        }
    }
    let given = settings.node().get("solver_type").map(|n| n.str()).transpose()?.unwrap_or("");
    let name = given.rsplit('.').next().unwrap_or(given);
    let name = if name.is_empty() { "automatic" } else { name };
    let entry = registry::require::<LinearSolverEntry>(name).map_err(|d| d.at(settings.key_place("solver_type")))?;
    let solver = (entry.build)(request)?;
    let asked = if given.is_empty() { "none named in the deck".to_owned() } else { format!("for \"{given}\"") };
    let says = format!("linear solver: {}; {asked}", solver.says());
    Ok((solver, says))
}

/// The solver of any system that takes the least memory.
///
/// # Errors
/// As [`make`].
pub(crate) fn frugal(request: &LinearSolverRequest<'_>) -> Result<Box<dyn LinearSolver>> {
    multigrid_from(request, [0; 2], false)
}

/// Unknowns from which on PETSc solves by multigrid where the deck names a solver that works on one rank alone and does not say
/// who shall: rank 0 is as fast below.
#[cfg(feature = "petsc")]
const MULTIGRID: usize = 70_000;

/// As [`MULTIGRID`], for systems with multipliers, which PETSc can only factorise: rank 0 does it several times faster, so
/// this is where its memory may end.
#[cfg(feature = "petsc")]
const FACTORISED: usize = 500_000;

/// Unknowns of all ranks; collective.
pub(crate) fn unknowns_of_all(part: &ModelPart, system: &System) -> usize {
    let own = system.dofs.dofs().iter().filter(|dof| part.owns_node(dof.node as usize)).count();
    if part.share.is_some() { part.ranks.total(own as f64) as usize } else { own }
}

/// PETSc's solver for several ranks, and a sentence about it; `None` where rank 0 shall solve for all.
///
/// `is_shared` tells that the deck's solver works where the rows are itself. `petsc_engine` names an engine, or is `"automatic"` or `"none"`; `petsc_options` are words of PETSc's own command line.
///
/// # Errors
/// An unknown engine.
#[cfg(feature = "petsc")]
pub(super) fn petsc(
    settings: &Settings,
    unknowns: usize,
    has_multipliers: bool,
    is_shared: bool,
) -> Result<Option<(zelus_petsc::PetscSettings, String)>> {
    use zelus_petsc::{PetscEngine, PetscSettings};
    let word = |key: &str| settings.node().get(key).map(|n| n.str()).transpose().map(|word| word.unwrap_or(""));
    let number = |key: &str| settings.node().get(key).and_then(|n| n.as_f64());
    let name = word("petsc_engine")?;
    let enough = if has_multipliers { FACTORISED } else { MULTIGRID };
    if name == "none" || (name.is_empty() && (is_shared || unknowns < enough)) {
        return Ok(None);
    }
    let engine = PetscEngine::find(name);
    if engine.is_none() && !matches!(name, "" | "automatic") {
        let known: Vec<&str> = PetscEngine::ALL.into_iter().map(PetscEngine::name).collect();
        let problem = settings.error("petsc_engine", "unknown-engine", format!("there is no engine {name:?} of PETSc"));
        return Err(problem.remedy(format!("use {}, automatic or none", known.join(", "))).into());
    }
    let usual = PetscSettings::default();
    let chosen = PetscSettings {
        engine,
        tolerance: number("tolerance").unwrap_or(usual.tolerance).min(usual.tolerance),
        iterations: number("max_iteration").map_or(usual.iterations, |n| (n as usize).max(usual.iterations)),
        options: word("petsc_options")?.to_owned(),
        ..usual
    };
    let engine = engine.map_or("an engine chosen by size", PetscEngine::name);
    Ok(Some((chosen, format!("linear solver: PETSc over all ranks, {engine}"))))
}

fn direct(_: &LinearSolverRequest<'_>) -> Result<Box<dyn LinearSolver>> {
    Ok(create(Engine::Direct(DirectSettings::default())))
}

/// Multigrid by the settings of a deck, with the direct engine below `least` equations where they do not say otherwise, and where it
/// costs less if multigrid `falls_back`.
fn multigrid_from(
    request: &LinearSolverRequest<'_>,
    least: [usize; 2],
    falls_back: bool,
) -> Result<Box<dyn LinearSolver>> {
    let number = |key: &str| request.settings.node().get(key).and_then(|n| n.as_f64());
    let tolerance = number("tolerance").map_or(request.tolerance, |tolerance| tolerance.min(request.tolerance));
    Ok(create(Engine::Multigrid(MultigridSettings {
        tolerance,
        loosest: if number("tolerance").is_some() { tolerance } else { LOOSEST },
        least: number("direct_below").map_or(least, |equations| [equations as usize; 2]),
        falls_back,
        ..MultigridSettings::default()
    })))
}

fn multigrid(request: &LinearSolverRequest<'_>) -> Result<Box<dyn LinearSolver>> {
    multigrid_from(request, MultigridSettings::default().least, false)
}

fn automatic(request: &LinearSolverRequest<'_>) -> Result<Box<dyn LinearSolver>> {
    let is_bounded = request.settings.node().get("memory_limit").is_some();
    multigrid_from(request, MultigridSettings::FASTER, !is_bounded)
}

fn krylov(request: &LinearSolverRequest<'_>) -> Result<KrylovSettings> {
    let settings = request.settings;
    let number = |key: &str| settings.node().get(key).and_then(|n| n.as_f64());
    let named = settings.node().get("preconditioner_type").map(Node::str).transpose()?.filter(|name| !name.is_empty());
    let preconditioner = match named {
        None => Preconditioner::Ilu0,
        Some(name) => {
            let entry = registry::require::<PreconditionerEntry>(name);
            entry.map_err(|d| d.at(settings.key_place("preconditioner_type")))?.build
        }
    };
    let usual = KrylovSettings::default();
    Ok(KrylovSettings {
        tolerance: number("tolerance").unwrap_or(usual.tolerance),
        iterations: number("max_iteration").map_or(usual.iterations, |iterations| iterations as usize),
        preconditioner,
        multipliers: request.multipliers,
    })
}

register! { PreconditionerEntry "ilu0",
    aliases: &["ilu", "ILU0Preconditioner", "ILUPreconditioner"],
    about: "incomplete LU on the pattern of the matrix",
    source: "Meijerink and van der Vorst (1977)",
    build: Preconditioner::Ilu0,
}
register! { PreconditionerEntry "diagonal",
    aliases: &["DiagonalPreconditioner"],
    about: "inverses of the diagonal blocks of the nodes",
    source: "block Jacobi; Saad, Iterative Methods for Sparse Linear Systems, § 4.1",
    build: Preconditioner::BlockJacobi,
}
register! { PreconditionerEntry "none",
    aliases: &["None", "Preconditioner"],
    about: "no preconditioner",
    source: "M = I",
    build: Preconditioner::Identity,
}
register! { LinearSolverEntry "sparse_lu",
    aliases: &["skyline_lu_factorization", "pardiso_lu", "pardiso_ldlt", "pardiso_llt", "sparse_cg", "sparse_qr",
        "super_lu", "SuperLUSolver", "LUSkylineFactorizationSolver", "umfpack", "mumps", "direct"],
    about: "multifrontal factorisation; the interface of contact in a dense Schur complement",
    source: "Duff and Reid (1983)",
    build: direct,
}
register! { LinearSolverEntry "automatic",
    about: "the fastest one: factorisation of small systems, multigrid for large ones",
    source: "sources of sparse_lu and amgcl",
    build: automatic,
}
register! { LinearSolverEntry "amgcl",
    aliases: &["AMGCL", "amgcl_raw", "multigrid", "deflated_cg"],
    about: "smoothed-aggregation multigrid with rigid-body modes, for conjugate gradients or GMRES",
    source: "Vaněk, Mandel and Brezina (1996); GMRES: Saad (1993)",
    build: multigrid,
}
register! { LinearSolverEntry "cg",
    aliases: &["CGSolver", "conjugate_gradient"],
    about: "conjugate gradients with incomplete LU; GMRES where contact leaves no symmetry, with condensed multipliers",
    source: "Hestenes and Stiefel (1952)",
    build: |request| Ok(create(Engine::ConjugateGradient(krylov(request)?))),
}
register! { LinearSolverEntry "gmres",
    aliases: &["bicgstab", "BICGSTABSolver", "tfqmr", "TFQMRSolver"],
    about: "restarted GMRES with incomplete LU; multipliers of contact are condensed",
    source: "Saad and Schultz (1986)",
    build: |request| Ok(create(Engine::Gmres { krylov: krylov(request)?, restart: 100 })),
}
