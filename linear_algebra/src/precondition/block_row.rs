//! A row of a block matrix under way.

/// Blocks in the order of their first entry.
pub(super) struct BlockRow {
    place: Vec<u32>,
    columns: Vec<u32>,
    /// Entries of the blocks.
    values: Vec<f32>,
    size: usize,
}

impl BlockRow {
    /// An empty row over `columns` blocks of `size` entries.
    pub(super) fn new(columns: usize, size: usize) -> Self {
        Self { place: vec![u32::MAX; columns], columns: Vec::new(), values: Vec::new(), size }
    }

    /// Where the entries of a block begin among [`BlockRow::entries`]; they are zero at first.
    pub(super) fn start(&mut self, column: u32) -> usize {
        self.place(column) * self.size
    }

    /// How many blocks it has so far.
    pub(super) fn blocks(&self) -> usize {
        self.columns.len()
    }

    /// The place of a block in the order of their first entry.
    #[inline]
    pub(super) fn place(&mut self, column: u32) -> usize {
        let at = &mut self.place[column as usize];
        if *at == u32::MAX {
            *at = self.columns.len() as u32;
            self.columns.push(column);
            self.values.resize(self.values.len() + self.size, 0.0);
        }
        *at as usize
    }

    /// The entries of the blocks so far.
    pub(super) fn entries(&mut self) -> &mut [f32] {
        &mut self.values
    }

    /// The entries of a block, zero at first.
    pub(super) fn block(&mut self, column: u32) -> &mut [f32] {
        let start = self.start(column);
        &mut self.values[start..start + self.size]
    }

    /// The same as a row of another matrix with as many columns; empty before.
    pub(super) fn copy(&mut self, (columns, values): (&[u32], &[f32])) {
        self.columns.extend_from_slice(columns);
        self.values.extend_from_slice(values);
        columns.iter().enumerate().for_each(|(at, &column)| self.place[column as usize] = at as u32);
    }

    /// Appends the blocks in ascending order; the row is empty then.
    pub(super) fn take(&mut self, indices: &mut Vec<u32>, values: &mut Vec<f32>) {
        let first = indices.len();
        indices.extend_from_slice(&self.columns);
        if self.columns.is_sorted() {
            values.extend_from_slice(&self.values);
        } else {
            indices[first..].sort_unstable();
            for &column in &indices[first..] {
                let start = self.place[column as usize] as usize * self.size;
                values.extend_from_slice(&self.values[start..start + self.size]);
            }
        }
        self.columns.drain(..).for_each(|column| self.place[column as usize] = u32::MAX);
        self.values.clear();
    }
}
