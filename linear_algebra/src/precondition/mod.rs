//! Approximate inverses.

mod aggregation;
mod block_jacobi;
mod block_matrix;
mod constrained;
mod ilu0;
mod multigrid;

pub(crate) use constrained::Constrained;
pub(crate) use multigrid::Multigrid;

use crate::csr::Csr;
use crate::solver::Preconditioner;
use crate::system::Layout;

/// An approximate inverse.
pub trait Precondition: Send + Sync {
    /// Replaces `x` by an approximation of `A⁻¹ x`.
    fn apply(&self, x: &mut [f64]);
}

struct Identity;

impl Precondition for Identity {
    fn apply(&self, _: &mut [f64]) {}
}

/// Makes an approximate inverse of a matrix whose equations have a layout.
pub type PreconditionerFactory = fn(&Csr, &Layout) -> Box<dyn Precondition>;

/// The preconditioner asked for, made for `matrix`.
pub(crate) fn create(kind: Preconditioner, matrix: &Csr, layout: &Layout) -> Box<dyn Precondition> {
    match kind {
        Preconditioner::Identity => Box::new(Identity),
        Preconditioner::BlockJacobi => Box::new(block_jacobi::BlockJacobi::new(matrix, &layout.node)),
        Preconditioner::Other(make) => make(matrix, layout),
        Preconditioner::Ilu0 => Box::new(ilu0::Ilu0::new(matrix)),
    }
}
