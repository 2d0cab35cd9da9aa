//! The one interface of all solvers, their reports and errors.

use crate::condensation::{CondensationSettings, NotCondensable};
use crate::csr::Csr;
use crate::state::{State, WrongState};
use crate::system::{Layout, System};

/// Report of one solve.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SolveReport {
    /// The engine that gave the solution.
    pub engine: &'static str,
    /// `‖b - A x‖ / ‖b‖` of the solution, measured on the true matrix; zero when `b` is zero.
    pub relative_residual: f64,
    /// Krylov iterations, or steps of iterative refinement for a direct engine.
    pub iterations: usize,
    /// Why another engine than the one asked for gave the solution.
    pub fallback: Option<String>,
    /// Seconds spent on ordering and symbolic factorisation; zero when reused.
    pub seconds_symbolic: f64,
    /// Seconds spent on numeric factorisation or on the preconditioner; zero when reused.
    pub seconds_numeric: f64,
    /// Seconds spent on the solution itself, refinement included.
    pub seconds_solve: f64,
}

impl SolveReport {
    /// Counts the iterations and seconds of another solve for the same solution.
    pub fn add_effort(&mut self, other: &Self) {
        self.iterations += other.iterations;
        self.seconds_symbolic += other.seconds_symbolic;
        self.seconds_numeric += other.seconds_numeric;
        self.seconds_solve += other.seconds_solve;
    }
}

/// Why a solve gave no solution.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SolveError {
    /// The matrix is singular; `equations` are the most suspicious ones, worst first.
    #[error("the matrix is singular{}; suspicious equations: {equations:?}",
        .rank_deficiency.map(|rank| format!(" (at least {rank} free motions)")).unwrap_or_default())]
    Singular {
        /// Equations with the largest entries in the near-null vector, or with tiny pivots; at most 16.
        equations: Vec<usize>,
        /// Number of tiny pivots, where it is known.
        rank_deficiency: Option<usize>,
    },
    /// The solution does not reach the accuracy asked for.
    #[error(
        "{engine} did not converge: relative residual {relative_residual:.3e} after {iterations} iterations, \
         {tolerance:.1e} wanted"
    )]
    NotConverged {
        /// The engine that ran last.
        engine: &'static str,
        /// Iterations done.
        iterations: usize,
        /// Residual reached.
        relative_residual: f64,
        /// Residual wanted.
        tolerance: f64,
    },
    /// The multipliers cannot be condensed, and the settings allow no other way.
    #[error("the multipliers cannot be condensed: {0}")]
    NotCondensable(NotCondensable),
    /// The input is unusable or the machine gave up; the text names the cause.
    #[error("{0}")]
    Failed(String),
}

/// A solver of sparse linear systems that keeps reusable data between solves.
///
/// ```
/// use zelus_linear_algebra::{Csr, Engine, Layout, Symmetry, System, create};
///
/// let matrix = Csr::from_triplets(2, &[(0, 0, 4.0), (0, 1, 1.0), (1, 0, 1.0), (1, 1, 3.0)]);
/// let layout = Layout::scalar(2);
/// let system = System::bulk(&layout, &matrix, Symmetry::PositiveDefinite);
/// let (rhs, mut x) = ([1.0, 2.0], [0.0; 2]);
/// let report = create(Engine::default()).solve(&system, &rhs, &mut x)?;
/// assert!((x[0] - 1.0 / 11.0).abs() < 1e-14 && (x[1] - 7.0 / 11.0).abs() < 1e-14);
/// assert!(report.relative_residual < 1e-14);
/// # Ok::<(), zelus_linear_algebra::SolveError>(())
/// ```
pub trait LinearSolver: Send {
    /// Name of the engine, as in [`SolveReport::engine`].
    fn name(&self) -> &'static str;

    /// The engine in words, and which systems it solves if it does not solve all.
    fn says(&self) -> String {
        self.name().to_owned()
    }

    /// Solves `(bulk + coupling) x = rhs`; `x` is the initial guess of iterative engines and the solution.
    ///
    /// # Errors
    /// [`SolveError::Singular`] when the matrix has no inverse, [`SolveError::NotConverged`] when the residual stays
    /// too large, [`SolveError::Failed`] for input that is not finite or does not fit. `x` is then not a solution.
    fn solve(&mut self, system: &System<'_>, rhs: &[f64], x: &mut [f64]) -> Result<SolveReport, SolveError>;

    /// Drops caches, so that a restarted run gives the same bits: later solutions depend on earlier matrices through
    /// [`LinearSolver::state`] only. Called at the start of each step of a run.
    fn forget(&mut self) {}

    /// State from the solves so far; a solver that wraps another passes on the other's.
    fn state(&self) -> Option<Box<dyn State>> {
        None
    }

    /// Restores the state that another of its kind has from the same systems.
    ///
    /// # Errors
    /// The state of another kind.
    fn resume(&mut self, _state: Box<dyn State>) -> Result<(), WrongState> {
        Ok(())
    }

    /// Sets the relative residual that is enough for the next solves; engines ask no more of themselves than their settings do.
    fn set_forcing_term(&mut self, _: f64) {}

    /// Bytes that it takes beside the matrix, about, for systems of this size; 0 where that is not known.
    fn needs(&self, _equations: usize, _entries: usize) -> u64 {
        0
    }

    /// Whether a small part without symmetry may join the coupling of this system at no cost.
    fn takes_loads(&self, _: &System<'_>) -> bool {
        false
    }

    /// Whether it solves systems of this size some of whose equations are inactive ([`Layout::inactive`](crate::Layout::inactive)).
    fn takes_inactive_rows(&self, _equations: usize, _entries: usize) -> bool {
        false
    }

    /// Whether further solves with the last matrix, of this size, only substitute into its factors.
    fn keeps_factors(&self, _equations: usize, _entries: usize) -> bool {
        false
    }

    /// Whether it solves systems of this size, over all ranks, where their rows are ([`System::shared`]).
    fn shares(&self, _equations: usize, _entries: usize) -> bool {
        false
    }

    /// Why the last solve did not condense multipliers that it should have.
    fn not_condensed(&self) -> Option<NotCondensable> {
        None
    }
}

/// Kind of solver to create, with its settings.
#[derive(Debug, Clone)]
pub enum Engine {
    /// Multifrontal factorisation with the interface in a dense Schur complement; the default.
    Direct(DirectSettings),
    /// Sparse LU with column ordering and partial pivoting; slow, for small or awkward systems.
    Lu,
    /// Conjugate gradients, for symmetric positive definite systems.
    ConjugateGradient(KrylovSettings),
    /// Restarted GMRES, for any system.
    Gmres {
        /// Accuracy and preconditioner.
        krylov: KrylovSettings,
        /// Directions kept before a restart.
        restart: usize,
    },
    /// Smoothed-aggregation multigrid with the near-null space of the layout, as the preconditioner of conjugate gradients
    /// or, with multipliers or without symmetry, of GMRES; multipliers leave by their constraints.
    Multigrid(MultigridSettings),
}

impl Default for Engine {
    fn default() -> Self {
        Self::Direct(DirectSettings::default())
    }
}

/// Settings of [`Engine::Direct`].
#[derive(Debug, Clone, PartialEq)]
pub struct DirectSettings {
    /// Systems of at most this many equations are solved by one dense LU.
    pub dense_below: usize,
    /// Interfaces of at most this many equations go into a dense Schur complement.
    pub interface_limit: usize,
    /// Numbers of a factor (of one of the two of a matrix without symmetry) from which on it is kept in single precision,
    /// where refinement makes up for it.
    pub single_from: usize,
    /// Relative residual above which a solution is refused.
    pub tolerance: f64,
    /// Largest number of steps of iterative refinement.
    pub refinements: usize,
}

impl Default for DirectSettings {
    fn default() -> Self {
        Self { dense_below: 150, interface_limit: 9000, single_from: 1 << 27, tolerance: 1e-6, refinements: 3 }
    }
}

/// Settings of the Krylov engines.
#[derive(Debug, Clone)]
pub struct KrylovSettings {
    /// Relative residual `‖b - A x‖ / ‖b‖` at which iteration stops.
    pub tolerance: f64,
    /// Largest number of iterations.
    pub iterations: usize,
    /// The preconditioner.
    pub preconditioner: Preconditioner,
    /// Treatment of systems that have multipliers.
    pub multipliers: Multipliers,
}

impl Default for KrylovSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-9,
            iterations: 1000,
            preconditioner: Preconditioner::default(),
            multipliers: Multipliers::default(),
        }
    }
}

/// Treatment of multipliers by a Krylov engine.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Multipliers {
    /// It leaves the system to the direct engine.
    #[default]
    Leave,
    /// It iterates on the whole system.
    Keep,
    /// It iterates on the system without them and recovers them.
    Condense(CondensationSettings),
}

/// An approximate inverse.
pub trait Precondition: Send + Sync {
    /// Replaces `x` by an approximation of `A⁻¹ x`.
    fn apply(&self, x: &mut [f64]);
}

/// Makes an approximate inverse of a matrix whose equations have a layout.
pub type PreconditionerFactory = fn(&Csr, &Layout) -> Box<dyn Precondition>;

/// Approximate inverses that speed up a Krylov engine.
#[derive(Debug, Clone, Copy, Default)]
pub enum Preconditioner {
    /// None.
    Identity,
    /// Inverses of the diagonal blocks of the nodes.
    BlockJacobi,
    /// Incomplete LU on the pattern of the matrix.
    #[default]
    Ilu0,
    /// One of another crate.
    Other(PreconditionerFactory),
}

/// Settings of [`Engine::Multigrid`].
#[derive(Debug, Clone, PartialEq)]
pub struct MultigridSettings {
    /// Relative residual at which iteration stops, with the equations of multipliers at the size of forces.
    pub tolerance: f64,
    /// The same for solves of which less is asked ([`LinearSolver::set_forcing_term`]), at most.
    pub loosest: f64,
    /// Largest number of iterations.
    pub iterations: usize,
    /// Equations below which the direct engine solves: where rows have many entries, as those of solids in space, and else.
    pub least: [usize; 2],
    /// Whether the direct engine takes over where a factorisation would have cost less than the iterations of a solve.
    pub falls_back: bool,
}

impl MultigridSettings {
    /// Equations from which on multigrid is faster than factorisation: in space, and else.
    pub const FASTER: [usize; 2] = [15_000, 300_000];
}

impl Default for MultigridSettings {
    fn default() -> Self {
        Self { tolerance: 1e-9, loosest: 1e-9, iterations: 300, least: [3_000; 2], falls_back: false }
    }
}
