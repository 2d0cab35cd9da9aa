//! A row of a block matrix under way.

use super::multiplier::BESIDE;

/// Blocks in the order of their first entry.
pub(super) struct BlockRow {
    place: Vec<u32>,
    columns: Vec<u32>,
    /// Entries of the blocks, and [`BESIDE`] more.
    values: Vec<f32>,
    size: usize,
}

impl BlockRow {
    /// An empty row over `columns` blocks of `size` entries.
    pub(super) fn new(columns: usize, size: usize) -> Self {
        Self { place: vec![u32::MAX; columns], columns: Vec::new(), values: vec![0.0; BESIDE], size }
    }

    /// Where the entries of a block begin among [`BlockRow::entries`]; they are zero at first.
    pub(super) fn start(&mut self, column: u32) -> usize {
        let at = &mut self.place[column as usize];
        if *at == u32::MAX {
            *at = self.columns.len() as u32;
            self.columns.push(column);
            // What stands behind the last block is no longer zero.
            let end = self.values.len() - BESIDE;
            self.values[end..].fill(0.0);
            self.values.resize(self.values.len() + self.size, 0.0);
        }
        *at as usize * self.size
    }

    /// The entries of the blocks so far.
    pub(super) fn entries(&mut self) -> &mut [f32] {
        &mut self.values[..self.columns.len() * self.size]
    }

    /// Their number.
    pub(super) fn len(&self) -> usize {
        self.columns.len()
    }

    /// The entries of the block at a place, and all behind them.
    pub(super) fn from(&mut self, at: usize) -> &mut [f32] {
        &mut self.values[at * self.size..]
    }

    /// The entries of a block, zero at first.
    pub(super) fn block(&mut self, column: u32) -> &mut [f32] {
        let start = self.start(column);
        &mut self.values[start..start + self.size]
    }

    /// The entries of a block, zero at first, and all behind them.
    pub(super) fn block_and_beside(&mut self, column: u32) -> &mut [f32] {
        let start = self.start(column);
        &mut self.values[start..]
    }

    /// The same as a row of another matrix with as many columns; empty before.
    pub(super) fn copy(&mut self, (columns, values): (&[u32], &[f32])) {
        self.columns.extend_from_slice(columns);
        self.values.splice(..0, values.iter().copied());
        columns.iter().enumerate().for_each(|(at, &column)| self.place[column as usize] = at as u32);
    }

    /// Appends the blocks in ascending order; the row is empty then.
    pub(super) fn take(&mut self, indices: &mut Vec<u32>, values: &mut Vec<f32>) {
        let first = indices.len();
        indices.extend_from_slice(&self.columns);
        if self.columns.is_sorted() {
            values.extend_from_slice(&self.values[..self.columns.len() * self.size]);
        } else {
            indices[first..].sort_unstable();
            for &column in &indices[first..] {
                let start = self.place[column as usize] as usize * self.size;
                values.extend_from_slice(&self.values[start..start + self.size]);
            }
        }
        self.columns.drain(..).for_each(|column| self.place[column as usize] = u32::MAX);
        self.values.clear();
        self.values.resize(BESIDE, 0.0);
    }
}
