//! Sparse linear algebra: matrices, orderings and solvers; knows nothing of finite elements.
//!
//! A [`System`] is a [`Csr`] matrix in two parts, the bulk and the coupling of an interface, with stamps that tell
//! what changed; [`create`] makes a [`LinearSolver`] for it. Every answer has passed a check of its true residual,
//! and none depends on the number of threads.

mod check;
mod csr;
mod dense;
mod dense_lu;
mod direct;
mod equilibrate;
mod gmres;
mod interface;
mod lu;
mod multifrontal;
mod ordering;
mod scatter;
mod solver;
mod symbolic;
mod system;
pub mod vector;

pub use csr::Csr;
pub use solver::{DirectSettings, Engine, KrylovSettings, LinearSolver, Preconditioner, SolveError, SolveReport};
pub use system::{Layout, Symmetry, System};

/// A solver of the kind asked for.
pub fn create(engine: Engine) -> Box<dyn LinearSolver> {
    match engine {
        Engine::Direct(settings) => Box::new(direct::DirectSolver::new(settings)),
        Engine::Lu | Engine::ConjugateGradient(_) | Engine::Gmres { .. } => Box::new(lu::LuSolver::default()),
    }
}
