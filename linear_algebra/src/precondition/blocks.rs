//! What is left of a system once its multipliers are gone: a matrix of node blocks in single precision, and solves with it.
//!
//! Vectors are in single precision, too, so an iteration moves a third of the bytes of one with the system itself; what rounding
//! leaves is corrected by the next solve, for a residual in double precision.

use std::sync::Arc;

use super::block_matrix::{BlockMatrix, Into};
use super::multigrid::Multigrid;
use crate::ghosts::Ghosts;
use crate::iterations::gmres;

/// Directions kept in a solve, and its iterations at most.
const RESTART: usize = 80;

/// A matrix of blocks, own rows.
pub(crate) struct Blocks {
    pub(super) matrix: Arc<BlockMatrix>,
    /// What the matrix was divided by.
    pub(super) size: f64,
    /// Which rows are those of the bulk.
    pub(super) of_bulk: Vec<bool>,
    pub(super) ghosts: Ghosts,
}

impl Blocks {
    /// What the matrix was divided by.
    pub(crate) fn size(&self) -> f64 {
        self.size
    }

    /// Replaces `b`, own entries, by an approximate solution that leaves the share `aim` of `b`; gives the iterations, at most `most`.
    /// Collective.
    pub(crate) fn solve(&self, levels: &Multigrid, b: &mut [f64], aim: f64, most: usize) -> usize {
        let largest = self.ghosts.largest(b.iter().fold(0.0_f64, |m, v| m.max(v.abs())));
        if largest == 0.0 || !largest.is_finite() {
            b.fill(0.0);
            return 0;
        }
        let rhs: Vec<f32> = b.iter().map(|b| (b / largest) as f32).collect();
        let mut x = vec![0.0_f32; rhs.len()];
        let mut all = Vec::new();
        let multiply = |x: &[f32], y: &mut [f32]| {
            if self.ghosts.processes().is_none() {
                return self.matrix.mul_vec(x, y, Into::Set);
            }
            all.clear();
            all.extend_from_slice(x);
            all.resize(self.ghosts.all() * self.matrix.height, 0.0);
            self.ghosts.spread(&mut all, self.matrix.height);
            self.matrix.mul_vec(&all, y, Into::Set);
        };
        let precondition = |r: &mut [f32], _: f64| levels.apply(r);
        let progress = gmres(&self.ghosts, multiply, precondition, &rhs, &mut x, RESTART, most.min(RESTART), aim);
        b.iter_mut().zip(&x).for_each(|(b, x)| *b = f64::from(*x) * largest / self.size);
        progress.iterations
    }
}
