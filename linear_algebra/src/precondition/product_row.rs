//! A row of a product of block matrices under way.

use super::block_row::BlockRow;
use super::multiplier::{Multiply, lanes, multiplier};

/// Sums of products for the blocks of a [`BlockRow`], in its order, until they are written there.
pub(super) struct ProductRow {
    shape: [usize; 3],
    multiply: Multiply,
    sums: Vec<f32>,
}

impl ProductRow {
    /// For products of blocks of a shape `[h, k, w]`.
    pub(super) fn new(shape: [usize; 3]) -> Self {
        Self { shape, multiply: multiplier(shape), sums: Vec::new() }
    }

    /// Adds the product of two blocks to what stands in a column of the row; see [`Multiply`].
    #[inline]
    pub(super) fn add(&mut self, row: &mut BlockRow, column: u32, a: &[f32], b: &[f32]) {
        self.add_at(row.place(column), a, b);
    }

    /// The same for the block at a place of the row: one that has sums, or the next.
    #[inline]
    pub(super) fn add_at(&mut self, place: usize, a: &[f32], b: &[f32]) {
        let size = lanes(self.shape[0]) * self.shape[2];
        let begin = place * size;
        if begin == self.sums.len() {
            self.sums.resize(begin + size, 0.0);
        }
        (self.multiply)(self.shape, a, b, &mut self.sums[begin..begin + size]);
    }

    /// Writes the sums to the blocks of the row; there are none then.
    pub(super) fn write(&mut self, row: &mut BlockRow) {
        let height = self.shape[0];
        let columns = self.sums.chunks_exact(lanes(height));
        row.entries().chunks_exact_mut(height).zip(columns).for_each(|(to, sum)| to.copy_from_slice(&sum[..height]));
        self.sums.clear();
    }
}
