//! Iterations on any product with a matrix: conjugate gradients, restarted GMRES, and where to begin them.

mod previous_solutions;
mod conjugate_gradient;
mod gmres;

pub(crate) use conjugate_gradient::conjugate_gradient;
pub(crate) use gmres::Gmres;
pub(crate) use previous_solutions::{PreviousSolution, PreviousSolutions};

/// How far an iteration came.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Progress {
    pub(crate) iterations: usize,
    /// Relative residual of the first guess.
    pub(crate) start: f64,
    pub(crate) relative_residual: f64,
}
