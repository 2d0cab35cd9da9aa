//! A row of a product of block matrices under way.

use super::block_row::BlockRow;
use super::multiplier::{Multiply, lanes, multiplier};

/// Sums of products for the blocks of a [`BlockRow`], in its order, until they are written there.
pub(super) struct ProductRow {
    shape: [usize; 3],
    multiply: Multiply,
    sums: Vec<f32>,
    places: Vec<u32>,
}

impl ProductRow {
    /// For products of blocks of a shape `[h, k, w]`.
    pub(super) fn new(shape: [usize; 3]) -> Self {
        Self { shape, multiply: multiplier(shape), sums: Vec::new(), places: Vec::new() }
    }

    /// Adds the products of a block with blocks that stand side by side to the values in these columns of the row; see [`Multiply`].
    #[inline]
    pub(super) fn add(&mut self, row: &mut BlockRow, columns: &[u32], a: &[f32], b: &[f32]) {
        self.places.clear();
        self.places.extend(columns.iter().map(|&column| row.place(column) as u32));
        self.multiply(row.blocks(), a, b);
    }

    /// The same for as many blocks as the row has, one after the other.
    #[inline]
    pub(super) fn add_to_each(&mut self, row: &BlockRow, a: &[f32], b: &[f32]) {
        self.places.clear();
        self.places.extend(0..row.blocks() as u32);
        self.multiply(row.blocks(), a, b);
    }

    fn multiply(&mut self, blocks: usize, a: &[f32], b: &[f32]) {
        let size = lanes(self.shape[0]) * self.shape[2];
        self.sums.resize(blocks * size, 0.0);
        (self.multiply)(self.shape, a, b, &self.places, &mut self.sums);
    }

    /// Writes the sums to the blocks of the row; there are none then.
    pub(super) fn write(&mut self, row: &mut BlockRow) {
        let height = self.shape[0];
        let columns = self.sums.chunks_exact(lanes(height));
        row.entries().chunks_exact_mut(height).zip(columns).for_each(|(to, sum)| to.copy_from_slice(&sum[..height]));
        self.sums.clear();
    }
}
