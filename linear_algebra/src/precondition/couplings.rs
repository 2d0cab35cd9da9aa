//! Couplings between the own blocks of a matrix.

use super::block_matrix::BlockMatrix;
use crate::parallel;

/// Blocks in a row beyond which it may be a hub; nodes of meshes have fewer.
pub(super) const HUB: usize = 200;
/// Times the mean number of blocks in a row beyond which a row is a hub; rows of coarse matrices may all be long.
const LONGER: usize = 4;
/// Rows that a thread takes at a time, at least.
const ROWS: usize = 256;

/// Couplings of blocks that are of one body and no hubs. Aggregates and lines end where the blocks of others begin, and at the boundary
/// of a body: bodies in contact move apart and slide.
pub(super) struct Couplings<'a> {
    pub(super) matrix: &'a BlockMatrix,
    pub(super) bodies: &'a [u32],
    pub(super) positions: &'a [[f64; 3]],
    /// Which blocks are hubs, e.g. the reference node of a coupling.
    pub(super) is_hub: Vec<bool>,
    /// Squares of the norms of the diagonal blocks.
    diagonal: Vec<f64>,
}

impl<'a> Couplings<'a> {
    /// Couplings in the own rows of a matrix; `bodies` says which each block is of, and `positions` where it is, with coordinates that are
    /// not numbers where they are not known. There may be no positions.
    pub(super) fn new(matrix: &'a BlockMatrix, bodies: &'a [u32], positions: &'a [[f64; 3]]) -> Self {
        let blocks: usize = (0..matrix.rows).map(|i| matrix.row(i).0.len()).sum();
        let is_hub = |i| {
            let length = matrix.row(i).0.len();
            length > HUB && length * matrix.rows > LONGER * blocks
        };
        let size = matrix.size();
        let diagonal = parallel::map(matrix.rows, ROWS, |i| {
            let (columns, values) = matrix.row(i);
            columns.binary_search(&(i as u32)).map_or(0.0, |at| square(&values[at * size..(at + 1) * size]))
        });
        Self { matrix, bodies, positions, is_hub: (0..matrix.rows).map(is_hub).collect(), diagonal }
    }

    /// The blocks that a block is coupled to, with the square of the norm of the coupling and the geometric mean of those of both diagonal
    /// blocks; none of a hub.
    pub(super) fn of(&self, i: usize) -> impl Iterator<Item = (u32, f64, f64)> + '_ {
        let (columns, values) = if self.is_hub[i] { (&[][..], &[][..]) } else { self.matrix.row(i) };
        let is_neighbour =
            move |j: usize| j != i && j < self.matrix.rows && self.bodies[j] == self.bodies[i] && !self.is_hub[j];
        let blocks = columns.iter().zip(values.chunks_exact(self.matrix.size()));
        blocks
            .filter(move |(j, _)| is_neighbour(**j as usize))
            .map(move |(&j, block)| (j, square(block), (self.diagonal[i] * self.diagonal[j as usize]).sqrt()))
    }

    /// One over the square of the distance of two blocks, infinity where that is not known.
    pub(super) fn nearness(&self, i: usize, j: usize) -> f64 {
        let [Some(a), Some(b)] = [i, j].map(|block| self.positions.get(block)) else { return f64::INFINITY };
        let squares = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).filter(|square| !square.is_nan());
        1.0 / squares.sum::<f64>()
    }
}

/// Square of the norm of a block.
fn square(block: &[f32]) -> f64 {
    block.iter().map(|&v| f64::from(v).powi(2)).sum()
}
