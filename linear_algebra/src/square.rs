//! Dense square matrices in tiles of columns; of a symmetric one only the lower triangle stands.

use crate::columns::{subtract_product, subtract_sums};
use crate::dense::{PARALLEL_WORK, for_each};
use crate::parallel;

/// Columns of a tile.
pub(crate) const TILE: usize = 192;
/// Numbers that are worth giving back; the allocator passes as many on to the system.
const MUCH: usize = 1 << 22;

/// A square matrix, column-major in its tiles; tiles of a symmetric one begin with the row of their first column.
///
/// Entries above the diagonal in the tiles of a symmetric matrix are not used.
#[derive(Debug, Default)]
pub(crate) struct Square {
    order: usize,
    symmetric: bool,
    values: Vec<f64>,
    /// Numbers of the leading tiles that are gone.
    gone: usize,
}

/// A tile for writing.
pub(crate) struct Tile<'a> {
    /// First column.
    pub(crate) column: usize,
    /// First row.
    pub(crate) row: usize,
    pub(crate) width: usize,
    /// `(order - row) × width` numbers.
    pub(crate) values: &'a mut [f64],
}

impl Square {
    /// Numbers that a matrix takes.
    pub(crate) fn size(order: usize, symmetric: bool) -> usize {
        if symmetric { start(order, order) } else { order * order }
    }

    /// A matrix in memory of at least [`Square::size`] numbers, which keep their values.
    pub(crate) fn over(values: Vec<f64>, order: usize, symmetric: bool) -> Self {
        Self { order, symmetric, values, gone: 0 }
    }

    pub(crate) fn order(&self) -> usize {
        self.order
    }

    pub(crate) fn is_symmetric(&self) -> bool {
        self.symmetric
    }

    /// The memory, for another use.
    pub(crate) fn into_values(self) -> Vec<f64> {
        self.values
    }

    /// First row that stands in a column.
    fn first_row(&self, column: usize) -> usize {
        if self.symmetric { column - column % TILE } else { 0 }
    }

    /// Where an entry stands.
    fn place(&self, row: usize, column: usize) -> usize {
        if !self.symmetric {
            return column * self.order + row - self.gone;
        }
        let first = self.first_row(column);
        start(self.order, first) + (column - first) * (self.order - first) + (row - first) - self.gone
    }

    /// Rows `from..` of a column, which stand there.
    pub(crate) fn below(&self, column: usize, from: usize) -> &[f64] {
        &self.values[self.place(from, column)..][..self.order - from]
    }

    /// An entry on or below the diagonal, or anywhere when not symmetric, for writing.
    pub(crate) fn entry_mut(&mut self, row: usize, column: usize) -> &mut f64 {
        let at = self.place(row, column);
        &mut self.values[at]
    }

    /// Gives the memory of the tiles before that of `column` back to the system, where it is much: they are gone.
    pub(crate) fn forget_before(&mut self, column: usize) {
        let first = column - column % TILE;
        let gone = if self.symmetric { start(self.order, first) } else { first * self.order };
        if gone >= MUCH {
            self.values.drain(..gone);
            self.values.shrink_to_fit();
            self.gone = gone;
        }
    }

    /// A diagonal entry.
    pub(crate) fn diagonal(&self, at: usize) -> f64 {
        self.values[self.place(at, at)]
    }

    /// All tiles.
    pub(crate) fn tiles_mut(&mut self) -> Vec<Tile<'_>> {
        let (order, symmetric) = (self.order, self.symmetric);
        let mut rest = &mut self.values[..];
        (0..order)
            .step_by(TILE)
            .map(|column| {
                let (row, width) = (if symmetric { column } else { 0 }, TILE.min(order - column));
                let (values, tail) = std::mem::take(&mut rest).split_at_mut(width * (order - row));
                rest = tail;
                Tile { column, row, width, values }
            })
            .collect()
    }

    /// Runs `work`, of so many multiplications an entry, on every tile.
    pub(crate) fn each_tile(&mut self, effort: usize, work: impl Fn(&mut Tile<'_>) + Sync) {
        for_each(self.order * self.order * effort > PARALLEL_WORK, self.tiles_mut(), work);
    }

    /// `y -= A x`.
    pub(crate) fn mul_vec_subtract(&self, x: &[f64], y: &mut [f64]) {
        let order = self.order;
        let columns: Vec<usize> = (0..order).step_by(TILE).collect();
        let of_tile = |&first: &usize| {
            let (width, row) = (TILE.min(order - first), self.first_row(first));
            let stride = order - row;
            let tile = &self.values[self.place(row, first)..][..width * stride];
            let mut part = vec![0.0; stride];
            if !self.symmetric {
                subtract_product(&mut part, tile, stride, &x[first..first + width]);
                return part;
            }
            let (head, tail) = part.split_at_mut(width);
            for k in 0..width {
                let column = &tile[k * stride + k..k * stride + width];
                head[k] -= column[0] * x[first + k];
                for (i, entry) in (k + 1..width).zip(&column[1..]) {
                    head[i] -= entry * x[first + k];
                    head[k] -= entry * x[first + i];
                }
            }
            if !tail.is_empty() {
                for (k, head) in (0..).step_by(8).zip(head.chunks_mut(8)) {
                    let block = &tile[k * stride + width..];
                    subtract_product(tail, block, stride, &x[first + k..first + k + head.len()]);
                    subtract_sums(head, block, stride, &x[first + width..]);
                }
            }
            part
        };
        let parts: Vec<Vec<f64>> = if order * order > PARALLEL_WORK / 8 {
            parallel::map(columns.len(), 1, |at| of_tile(&columns[at]))
        } else {
            columns.iter().map(of_tile).collect()
        };
        for part in parts {
            let at = order - part.len();
            y[at..].iter_mut().zip(part).for_each(|(y, part)| *y += part);
        }
    }
}

/// Where the tile of column `first` of a symmetric matrix begins; the length of all tiles for its order.
fn start(order: usize, first: usize) -> usize {
    let tiles = first / TILE;
    let whole = tiles * TILE;
    let before = TILE * (tiles * order - TILE * (tiles * tiles.saturating_sub(1) / 2));
    before + (first - whole) * (order - whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lower_triangle_multiplies_as_the_whole_matrix() {
        for order in [1, 5, 192, 193, 500, 800] {
            let entry = |i: usize, j: usize| ((i.max(j) * 31 + i.min(j) * 17) % 23) as f64 - 11.0;
            let mut lower = Square::over(vec![f64::NAN; Square::size(order, true)], order, true);
            let mut full = Square::over(vec![0.0; Square::size(order, false)], order, false);
            for j in 0..order {
                for i in 0..order {
                    *full.entry_mut(i, j) = entry(i, j);
                    if i >= j {
                        *lower.entry_mut(i, j) = entry(i, j);
                    }
                }
            }
            let x: Vec<f64> = (0..order).map(|i| (i % 7) as f64 - 2.0).collect();
            let exact: Vec<f64> = (0..order).map(|i| (0..order).map(|j| -entry(i, j) * x[j]).sum()).collect();
            for matrix in [&lower, &full] {
                let mut y = vec![0.0; order];
                matrix.mul_vec_subtract(&x, &mut y);
                assert_eq!(y, exact, "{order}");
                assert_eq!(matrix.diagonal(order - 1), entry(order - 1, order - 1));
                assert_eq!(matrix.below(order / 2, order / 2).len(), order - order / 2);
            }
        }
    }

    #[test]
    fn what_is_left_of_a_matrix_stands_where_it_did() {
        for symmetric in [true, false] {
            let order = 3000;
            let mut matrix =
                Square::over((0..Square::size(order, symmetric)).map(|k| k as f64).collect(), order, symmetric);
            let from = |matrix: &Square, column: usize| matrix.below(column, column).to_vec();
            let whole = [2700, 2688, 2999].map(|column| from(&matrix, column));
            matrix.forget_before(300);
            assert_eq!(matrix.gone, 0, "too little to be worth it");
            matrix.forget_before(2700);
            assert!(matrix.gone >= MUCH);
            assert_eq!([2700, 2688, 2999].map(|column| from(&matrix, column)), whole);
        }
    }
}
