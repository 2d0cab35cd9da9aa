//! Solves and products with tall blocks of columns, whose numbers are in single or double precision and widened as they are read.
//!
//! Sums are taken in fixed order, so that results do not depend on the number of threads.

use crate::dense::{PARALLEL_WORK, for_each};

/// A number that factors are kept in.
pub(crate) trait FactorScalar: Copy + Send + Sync + Into<f64> {
    /// The nearest number to `value`.
    fn of(value: f64) -> Self;
}

impl FactorScalar for f64 {
    fn of(value: f64) -> Self {
        value
    }
}

impl FactorScalar for f32 {
    fn of(value: f64) -> Self {
        value as f32
    }
}

/// Columns of a tile.
const TILE: usize = 64;
/// Columns that one pass over a vector takes.
const PASS: usize = 8;
/// Columns of one pass of sums, and partial sums of each.
const SUMS: usize = 4;
/// Rows of a task.
const ROWS: usize = 2048;

/// Numbers of the lower trapezoid of `order` rows and `pivots` columns: tiles of columns, each from the row of its first column on.
pub(crate) fn trapezoid(order: usize, pivots: usize) -> usize {
    (0..pivots).step_by(TILE).map(|k| TILE.min(pivots - k) * (order - k)).sum()
}

/// Column, width and numbers of each tile of a trapezoid.
fn tiles<T>(mut values: &[T], order: usize, pivots: usize) -> Vec<(usize, usize, &[T])> {
    let tile = |k| {
        let width = TILE.min(pivots - k);
        let (tile, rest) = values.split_at(width * (order - k));
        values = rest;
        (k, width, tile)
    };
    (0..pivots).step_by(TILE).map(tile).collect()
}

/// Runs `work` on the first column and the numbers of each tile of a trapezoid.
fn each_tile<T: FactorScalar>(to: &mut [T], order: usize, pivots: usize, work: impl Fn(usize, &mut [T]) + Sync) {
    let mut rest = to;
    let mut tiles = Vec::with_capacity(pivots / TILE + 1);
    for k in (0..pivots).step_by(TILE) {
        let (tile, tail) = rest.split_at_mut(TILE.min(pivots - k) * (order - k));
        rest = tail;
        tiles.push((k, tile));
    }
    for_each(order * pivots > PARALLEL_WORK / 8, tiles, |(first, tile)| work(*first, tile));
}

/// Keeps the trapezoid of a matrix whose column `k` is `column(k)`; entries above the diagonal are not used.
pub(crate) fn keep_columns<'a, T: FactorScalar>(
    to: &mut [T],
    order: usize,
    pivots: usize,
    column: impl Fn(usize) -> &'a [f64] + Sync,
) {
    each_tile(to, order, pivots, |first, tile| {
        for (k, to) in (first..).zip(tile.chunks_mut(order - first)) {
            to.iter_mut().zip(&column(k)[first..]).for_each(|(to, &from)| *to = T::of(from));
        }
    });
}

/// Keeps the trapezoid of a matrix whose row `i` is `row(i)`; entries above the diagonal are not used.
pub(crate) fn keep_rows<'a, T: FactorScalar>(
    to: &mut [T],
    order: usize,
    pivots: usize,
    row: impl Fn(usize) -> &'a [f64] + Sync,
) {
    each_tile(to, order, pivots, |first, tile| {
        let stride = order - first;
        for i in first..order {
            let to = tile[i - first..].iter_mut().step_by(stride);
            to.zip(&row(i)[first..]).for_each(|(to, &from)| *to = T::of(from));
        }
    });
}

/// The diagonal of a trapezoid.
pub(crate) fn diagonal<T: FactorScalar>(trapezoid: &[T], order: usize, pivots: usize) -> Vec<f64> {
    let of_tile = |(first, width, tile): (usize, usize, &[T])| -> Vec<f64> {
        (0..width).map(|k| tile[k * (order - first + 1)].into()).collect()
    };
    tiles(trapezoid, order, pivots).into_iter().flat_map(of_tile).collect()
}

/// Solves with the first rows of a lower trapezoid; the rest of `local` loses their part.
pub(crate) fn forward<T: FactorScalar>(trapezoid: &[T], pivots: usize, local: &mut [f64]) {
    let order = local.len();
    for (first, width, tile) in tiles(trapezoid, order, pivots) {
        let stride = order - first;
        let (x, below) = local[first..].split_at_mut(width);
        for k in 0..width {
            let column = &tile[k * stride..k * stride + width];
            x[k] /= column[k].into();
            let (done, rest) = x.split_at_mut(k + 1);
            rest.iter_mut().zip(&column[k + 1..]).for_each(|(value, &entry)| *value -= entry.into() * done[k]);
        }
        let parallel = below.len() * width > PARALLEL_WORK / 8;
        let tasks = below.chunks_mut(ROWS).zip((width..).step_by(ROWS)).collect();
        for_each(parallel, tasks, |(rows, at)| subtract_product(rows, &tile[(*at).min(tile.len())..], stride, x));
    }
}

/// Solves with the transpose of the first rows of a lower trapezoid, the entries of `local` after them being known.
pub(crate) fn backward<T: FactorScalar>(trapezoid: &[T], pivots: usize, local: &mut [f64]) {
    let order = local.len();
    for (first, width, tile) in tiles(trapezoid, order, pivots).into_iter().rev() {
        let stride = order - first;
        let (x, below) = local[first..].split_at_mut(width);
        let parallel = below.len() * width > PARALLEL_WORK / 8;
        let tasks = x.chunks_mut(PASS).zip(tile.chunks(PASS * stride)).collect();
        for_each(parallel, tasks, |(x, columns)| subtract_sums(x, &columns[width..], stride, below));
        for k in (0..width).rev() {
            let column = &tile[k * stride..k * stride + width];
            let (now, known) = x[k..].split_first_mut().expect("k is a row of the tile");
            let sum: f64 = column[k + 1..].iter().zip(known).map(|(&entry, value)| entry.into() * *value).sum();
            *now = (*now - sum) / column[k].into();
        }
    }
}

/// `target -= C x`, where column `k` of C begins at `columns[k * stride]`.
pub(crate) fn subtract_product<T: FactorScalar>(target: &mut [f64], columns: &[T], stride: usize, x: &[f64]) {
    let rows = target.len();
    let mut passes = x.chunks_exact(PASS);
    let mut begin = 0;
    for x in &mut passes {
        let [a, b, c, d, e, f, g, h]: [&[T]; PASS] = std::array::from_fn(|k| &columns[begin + k * stride..][..rows]);
        for i in 0..rows {
            let near = (a[i].into() * x[0] + b[i].into() * x[1]) + (c[i].into() * x[2] + d[i].into() * x[3]);
            let far = (e[i].into() * x[4] + f[i].into() * x[5]) + (g[i].into() * x[6] + h[i].into() * x[7]);
            target[i] -= near + far;
        }
        begin += PASS * stride;
    }
    for &x in passes.remainder() {
        target.iter_mut().zip(&columns[begin..]).for_each(|(target, &entry)| *target -= entry.into() * x);
        begin += stride;
    }
}

/// `x -= Cᵀ y`, where column `k` of C begins at `columns[k * stride]`.
pub(crate) fn subtract_sums<T: FactorScalar>(x: &mut [f64], columns: &[T], stride: usize, y: &[f64]) {
    let rows = y.len();
    if rows == 0 {
        return;
    }
    let whole = rows - rows % SUMS;
    let mut begin = 0;
    let mut passes = x.chunks_exact_mut(SUMS);
    for x in &mut passes {
        let [a, b, c, d]: [&[T]; SUMS] = std::array::from_fn(|k| &columns[begin + k * stride..][..rows]);
        let mut sums = [[0.0; SUMS]; SUMS];
        for i in (0..whole).step_by(SUMS) {
            let y: [f64; SUMS] = std::array::from_fn(|lane| y[i + lane]);
            for (column, sums) in [a, b, c, d].into_iter().zip(&mut sums) {
                let column = &column[i..i + SUMS];
                for lane in 0..SUMS {
                    sums[lane] += column[lane].into() * y[lane];
                }
            }
        }
        for ((x, sums), column) in x.iter_mut().zip(sums).zip([a, b, c, d]) {
            let rest: f64 = column[whole..].iter().zip(&y[whole..]).map(|(&entry, y)| entry.into() * *y).sum();
            *x -= sums.iter().sum::<f64>() + rest;
        }
        begin += SUMS * stride;
    }
    for x in passes.into_remainder() {
        *x -= columns[begin..].iter().zip(y).map(|(&entry, y)| entry.into() * *y).sum::<f64>();
        begin += stride;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(i: usize, k: usize) -> f64 {
        if i == k { 3.0 } else { ((i * 7 + k * 13) % 11) as f64 / 64.0 - 0.0625 }
    }

    /// Solves with both triangles of a factor kept in `T`; its entries are exact in either precision.
    fn solves<T: FactorScalar>(order: usize, pivots: usize) {
        let columns: Vec<Vec<f64>> = (0..pivots).map(|k| (0..order).map(|i| entry(i, k)).collect()).collect();
        let mut kept = vec![T::of(0.0); trapezoid(order, pivots)];
        keep_columns(&mut kept, order, pivots, |k| &columns[k]);
        let rows: Vec<Vec<f64>> = (0..order).map(|i| (0..pivots).map(|k| entry(i, k)).collect()).collect();
        let mut by_rows = vec![T::of(0.0); kept.len()];
        keep_rows(&mut by_rows, order, pivots, |i| &rows[i]);
        assert!(kept.iter().zip(&by_rows).all(|(&a, &b)| a.into() == b.into()));
        let exact: Vec<f64> = (0..order).map(|i| 1.0 + (i % 5) as f64).collect();
        let lower = |i: usize, k: usize| if k <= i { entry(i, k) } else { 0.0 };
        let mut local: Vec<f64> = (0..order)
            .map(|i| {
                let own = if i < pivots { 0.0 } else { exact[i] };
                own + (0..pivots).map(|k| lower(i, k) * exact[k]).sum::<f64>()
            })
            .collect();
        forward(&kept, pivots, &mut local);
        let error = |x: &[f64]| x.iter().zip(&exact).map(|(x, e)| (x - e).abs()).fold(0.0, f64::max);
        assert!(error(&local) < 1e-9, "forward {order} {pivots}: {}", error(&local));
        for k in 0..pivots {
            local[k] = (0..order).map(|i| lower(i, k) * exact[i]).sum();
        }
        backward(&kept, pivots, &mut local);
        assert!(error(&local) < 1e-9, "backward {order} {pivots}: {}", error(&local));
    }

    #[test]
    fn both_triangles_are_solved_in_both_precisions() {
        for (order, pivots) in [(1, 1), (9, 4), (70, 70), (200, 64), (205, 131), (5000, 70)] {
            solves::<f64>(order, pivots);
            solves::<f32>(order, pivots);
        }
    }
}
