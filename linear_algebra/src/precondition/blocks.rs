//! The reduced system without multipliers: a matrix of node blocks in single precision, and solves with it.
//!
//! Vectors are in single precision, too, so an iteration moves a third of the bytes of one with the system itself; the next solve
//! corrects rounding errors, for a residual in double precision.

use std::sync::Arc;

use super::block_matrix::{BlockMatrix, Into};
use super::multigrid_hierarchy::Multigrid;
use super::single_precision::in_single;
use crate::ghosts::Ghosts;
use crate::iterations::Gmres;

/// Iterations of a solve at most: more of them gain less than the next solve, which begins from a residual in double precision.
const MOST: usize = 10;

/// A matrix of blocks, own rows.
pub(crate) struct Blocks {
    pub(super) matrix: Arc<BlockMatrix>,
    /// Divisor of the matrix.
    pub(crate) size: f64,
    /// Mask of rows that are those of the bulk.
    pub(super) of_bulk: Vec<bool>,
    pub(super) ghosts: Ghosts,
}

impl Blocks {
    /// Replaces `b`, own entries, by an approximate solution that leaves the share `forcing_term` of `b`; gives the iterations, at most `most`.
    /// Collective.
    pub(crate) fn solve(
        &self,
        levels: &Multigrid,
        method: &mut Gmres<f32>,
        b: &mut [f64],
        forcing_term: f64,
        most: usize,
    ) -> usize {
        let mut all = Vec::new();
        let multiply = |x: &[f32], y: &mut [f32]| {
            if self.ghosts.ranks().is_none() {
                return self.matrix.mul_vec(x, y, Into::Set);
            }
            all.clear();
            all.extend_from_slice(x);
            all.resize(self.ghosts.all() * self.matrix.height, 0.0);
            self.ghosts.spread(&mut all, self.matrix.height);
            self.matrix.mul_vec(&all, y, Into::Set);
        };
        let precondition = |r: &mut [f32], _: f64| levels.apply(r);
        let mut iterations = 0;
        in_single(&self.ghosts, b, self.size, |rhs| {
            iterations = method.approximate(&self.ghosts, multiply, precondition, rhs, most.min(MOST), forcing_term);
        });
        iterations
    }
}
