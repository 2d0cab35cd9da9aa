//! Sparse linear algebra: matrices, orderings and solvers; knows nothing of finite elements.
//!
//! A module uses only those above it in the list below. A [`System`] is a [`Csr`] matrix in two parts, the bulk and the coupling of an
//! interface, with stamps that tell changes; [`create`] makes a [`LinearSolver`] for it. Every solution has passed a check of its true
//! residual, and none depends on the number of threads.

pub mod address_space;
pub mod parallel;

pub mod packed;
mod state;

pub mod prefetch;
mod row_sums;
mod csr;
pub mod vector;
mod ghosts;
mod system;
mod reduced;

mod dense;
mod columns;
mod square;
mod dense_lu;

mod components;
mod condensation;
mod solver;
mod check;

mod ordering;
mod partition;

mod symbolic;
mod multifrontal;
mod equilibrate;
mod lu;

pub mod memory;
mod iterations;
mod precondition;

mod interface;
mod direct;

mod krylov;
mod multigrid_solver;

mod condition;
mod rank;

mod block_pivoting;
mod complementarity;

pub use block_pivoting::{BlockPivoting, Exchange};
pub use complementarity::Complementarity;
pub use components::Components;
pub use condensation::{Condensation, CondensationSettings, NotCondensable};
pub use condition::{Spectrum, condition_number};
pub use csr::Csr;
pub use ghosts::{Ghosts, Owned, Ranks};
pub use partition::{WeightedGraph, partition_graph};
pub use rank::rank;
pub use solver::{
    DirectSettings, Engine, KrylovSettings, LinearSolver, MultigridSettings, Multipliers, Precondition, Preconditioner,
    PreconditionerFactory, SolveError, SolveReport,
};
pub use state::{State, StateMapper, Unknowns, WrongState};
pub use system::{Layout, Symmetry, System};

/// A solver of the kind asked for.
pub fn create(engine: Engine) -> Box<dyn LinearSolver> {
    match engine {
        Engine::Direct(settings) => Box::new(direct::DirectSolver::new(settings)),
        Engine::Lu => Box::new(lu::LuSolver::default()),
        Engine::ConjugateGradient(settings) => {
            Box::new(krylov::KrylovSolver::new(krylov::Method::ConjugateGradient, settings))
        }
        Engine::Gmres { krylov: settings, restart } => {
            Box::new(krylov::KrylovSolver::new(krylov::Method::Gmres { restart }, settings))
        }
        Engine::Multigrid(settings) => Box::new(multigrid_solver::MultigridSolver::new(settings)),
    }
}
