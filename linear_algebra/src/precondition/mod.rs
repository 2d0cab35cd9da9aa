//! Approximate inverses.

mod aggregation;
mod block_jacobi;
mod block_row;
mod multiplier;
mod row_product;
mod sparse_sums;
mod product_row;
mod block_matrix;
mod blocks;
mod constrained;
mod ilu0;
mod reduced_system_cache;
mod couplings;
mod lines;
mod multigrid_hierarchy;
mod shared_levels;
mod single_precision;
mod workspaces;

pub(crate) use constrained::Constrained;
pub(crate) use multigrid_hierarchy::Multigrid;
pub(crate) use reduced_system_cache::ReducedSystemCache;

pub(crate) use crate::solver::Precondition;

use crate::csr::Csr;
use crate::solver::Preconditioner;
use crate::system::Layout;

struct Identity;

impl Precondition for Identity {
    fn apply(&self, _: &mut [f64]) {}
}

/// The preconditioner asked for, made for `matrix`.
pub(crate) fn create(kind: Preconditioner, matrix: &Csr, layout: &Layout) -> Box<dyn Precondition> {
    match kind {
        Preconditioner::Identity => Box::new(Identity),
        Preconditioner::BlockJacobi => Box::new(block_jacobi::BlockJacobi::new(matrix, &layout.node)),
        Preconditioner::Other(make) => make(matrix, layout),
        Preconditioner::Ilu0 => Box::new(ilu0::Ilu0::new(matrix)),
    }
}
