//! Dense LU with partial pivoting, tiled at fixed places; tiny pivots are replaced and reported.

use faer::linalg::triangular_solve::solve_unit_lower_triangular_in_place;
use faer::{MatMut, Par};

use crate::dense::{backward_upper, for_each, forward, subtract_product, view, view_mut};

/// Columns factorised at a time.
const BLOCK: usize = 96;
/// Columns of a tile of the update.
const COLUMN_TILE: usize = 192;
/// Columns below which the recursion of a block ends.
const LEAF: usize = 8;
/// Entries below which threads cost more than they gain.
const PARALLEL_ENTRIES: usize = 256 * 256;

/// Row exchanges and replaced pivots of a factorisation `P A = L U`.
#[derive(Debug, Clone, Default)]
pub(crate) struct Pivots {
    /// Row exchanged with row `k` at step `k`.
    pub(crate) exchanges: Vec<u32>,
    /// Steps whose pivot was below the limit and was replaced by it.
    pub(crate) replaced: Vec<u32>,
}

impl Pivots {
    /// Applies the exchanges to a vector.
    pub(crate) fn permute(&self, x: &mut [f64]) {
        for (k, &with) in self.exchanges.iter().enumerate() {
            x.swap(k, with as usize);
        }
    }

    /// Applies the exchanges to the rows of each column.
    pub(crate) fn permute_rows(&self, mut matrix: MatMut<'_, f64>) {
        exchange_rows(&self.exchanges, matrix.as_mut());
    }
}

/// Factorises a square matrix of order `n` in place; pivots smaller than `limit` become `±limit`.
pub(crate) fn factorise(values: &mut [f64], n: usize, limit: f64) -> Pivots {
    let mut pivots = Pivots { exchanges: Vec::with_capacity(n), replaced: Vec::new() };
    let mut next = ColumnBlock::new(BLOCK.min(n));
    if n > 0 {
        next.factorise(view_mut(values, n, n).get_mut(.., ..next.width), limit);
    }
    let mut k = 0;
    while k < n {
        let block = next;
        let width = block.width;
        pivots.exchanges.extend(block.exchanges.iter().map(|&row| row + k as u32));
        pivots.replaced.extend(block.replaced.iter().map(|&step| step + k as u32));
        let after = k + width;
        next = ColumnBlock::new(BLOCK.min(n - after));
        let (left, right) = values.split_at_mut(n * after);
        let done = view(&left[n * k..], n, width).subrows(k, n - k);
        let mut tiles = Vec::new();
        if next.width > 0 {
            let (head, mut tail) = right.split_at_mut(n * next.width);
            tiles.push((view_mut(head, n, next.width), Some(&mut next)));
            while !tail.is_empty() {
                let columns = COLUMN_TILE.min(tail.len() / n);
                let (tile, rest) = tail.split_at_mut(n * columns);
                tiles.push((view_mut(tile, n, columns), None));
                tail = rest;
            }
        }
        // The next block is factorised by the task that updates it, while others update the rest.
        for_each((n - after) * (n - after) > PARALLEL_ENTRIES, tiles, |(tile, then)| {
            let mut tile = tile.as_mut().subrows_mut(k, n - k);
            exchange_rows(&block.exchanges, tile.as_mut());
            let (mut upper, mut lower) = tile.split_at_row_mut(width);
            solve_unit_lower_triangular_in_place(done.subrows(0, width), upper.as_mut(), Par::Seq);
            subtract_product(lower.as_mut(), done.subrows(width, n - after), upper.as_ref());
            if let Some(next) = then {
                next.factorise(lower, limit);
            }
        });
        k = after;
    }
    exchange_left(values, n, &pivots.exchanges);
    pivots
}

/// Solves `A x = b` in place with the factors of [`factorise`].
pub(crate) fn solve(values: &[f64], n: usize, pivots: &Pivots, x: &mut [f64]) {
    pivots.permute(x);
    let factor = view(values, n, n);
    forward(factor, x);
    backward_upper(factor, x);
}

/// Applies to each finished block of columns the exchanges of the blocks after it.
fn exchange_left(values: &mut [f64], n: usize, exchanges: &[u32]) {
    let tiles: Vec<(usize, &mut [f64])> = values.chunks_mut((n * BLOCK).max(1)).enumerate().collect();
    for_each(n * n > PARALLEL_ENTRIES, tiles, |(block, columns)| {
        let done = ((*block + 1) * BLOCK).min(n);
        for column in columns.chunks_mut(n) {
            for k in done..n {
                column.swap(k, exchanges[k] as usize);
            }
        }
    });
}

fn exchange_rows(exchanges: &[u32], mut matrix: MatMut<'_, f64>) {
    for j in 0..matrix.ncols() {
        if let Some(column) = matrix.as_mut().col_mut(j).try_as_col_major_mut() {
            let column = column.as_slice_mut();
            for (k, &with) in exchanges.iter().enumerate() {
                column.swap(k, with as usize);
            }
        }
    }
}

/// A block of columns, of all rows from its diagonal on.
struct ColumnBlock {
    width: usize,
    exchanges: Vec<u32>,
    replaced: Vec<u32>,
}

impl ColumnBlock {
    fn new(width: usize) -> Self {
        Self { width, exchanges: Vec::with_capacity(width), replaced: Vec::new() }
    }

    fn factorise(&mut self, matrix: MatMut<'_, f64>, limit: f64) {
        self.recurse(matrix, 0, limit);
    }

    /// Factorises a block whose first row is step `from`; exchanges count from the first row of the whole block.
    fn recurse(&mut self, mut matrix: MatMut<'_, f64>, from: usize, limit: f64) {
        let width = matrix.ncols();
        if width <= LEAF {
            return self.leaf(matrix, from, limit);
        }
        let half = (width / 2).next_multiple_of(LEAF).min(width - 1);
        let (mut left, mut right) = matrix.as_mut().split_at_col_mut(half);
        self.recurse(left.as_mut(), from, limit);
        let local: Vec<u32> = self.exchanges[from..].iter().map(|&row| row - from as u32).collect();
        exchange_rows(&local, right.as_mut());
        let (upper_left, lower_left) = left.as_ref().split_at_row(half);
        let (mut upper, mut lower) = right.split_at_row_mut(half);
        solve_unit_lower_triangular_in_place(upper_left, upper.as_mut(), Par::Seq);
        subtract_product(lower.as_mut(), lower_left, upper.as_ref());
        self.recurse(lower, from + half, limit);
        let local: Vec<u32> = self.exchanges[from + half..].iter().map(|&row| row - (from + half) as u32).collect();
        let rows = matrix.nrows();
        exchange_rows(&local, matrix.submatrix_mut(half, 0, rows - half, half));
    }

    fn leaf(&mut self, mut matrix: MatMut<'_, f64>, from: usize, limit: f64) {
        let (rows, width) = (matrix.nrows(), matrix.ncols());
        let mut columns: Vec<&mut [f64]> = matrix
            .as_mut()
            .col_iter_mut()
            .map(|column| column.try_as_col_major_mut().expect("columns are contiguous").as_slice_mut())
            .collect();
        for k in 0..width {
            let mut best = k;
            for i in k + 1..rows {
                if columns[k][i].abs() > columns[k][best].abs() {
                    best = i;
                }
            }
            for column in &mut columns {
                column.swap(k, best);
            }
            self.exchanges.push((from + best) as u32);
            let (head, tail) = columns.split_at_mut(k + 1);
            let pivot_column = &mut *head[k];
            if pivot_column[k].abs() < limit {
                self.replaced.push((from + k) as u32);
                pivot_column[k] = limit.copysign(pivot_column[k]);
            }
            let inverse = 1.0 / pivot_column[k];
            pivot_column[k + 1..].iter_mut().for_each(|a| *a *= inverse);
            for column in tail {
                let factor = column[k];
                if factor != 0.0 {
                    column[k + 1..].iter_mut().zip(&pivot_column[k + 1..]).for_each(|(a, l)| *a -= factor * l);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pseudo_random(n: usize) -> Vec<f64> {
        let mut state = 1_u64;
        (0..n)
            .map(|_| {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                (state >> 33) as f64 / 2f64.powi(31) - 0.5
            })
            .collect()
    }

    #[test]
    fn solves_every_size() {
        for n in [1, 2, 7, 8, 9, 95, 96, 97, 300, 450] {
            let a = pseudo_random(n * n);
            let x: Vec<f64> = pseudo_random(n);
            let mut b: Vec<f64> = (0..n).map(|i| (0..n).map(|j| a[i + n * j] * x[j]).sum()).collect();
            let mut factor = a.clone();
            let pivots = factorise(&mut factor, n, 1e-200);
            assert!(pivots.replaced.is_empty() && pivots.exchanges.len() == n);
            solve(&factor, n, &pivots, &mut b);
            let error = b.iter().zip(&x).map(|(b, x)| (b - x).abs()).fold(0.0, f64::max);
            assert!(error < 1e-9, "size {n}: error {error}");
        }
    }

    #[test]
    fn a_zero_pivot_is_replaced_and_named() {
        let mut a = vec![1.0, 1.0, 1.0, 1.0];
        assert_eq!(factorise(&mut a, 2, 1e-8).replaced, [1]);
    }
}
