//! Dense kernels cut into tiles at fixed places, so that results do not depend on the number of threads.
//!
//! All matrices are column-major. Each tile is computed by one sequential call; threads only share the tiles out.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_unit_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Accum, MatMut, MatRef, Par};

use crate::parallel;

/// Columns of a block of a factorisation.
const BLOCK: usize = 128;
/// Rows of a tile below the diagonal block.
const ROW_TILE: usize = 256;
/// Columns of a tile of an update.
const COLUMN_TILE: usize = 192;
/// Multiplications below which threads cost more than they gain.
pub(crate) const PARALLEL_WORK: usize = 1 << 21;

/// Views a column-major slice.
pub(crate) fn view(values: &[f64], rows: usize, columns: usize) -> MatRef<'_, f64> {
    MatRef::from_column_major_slice(&values[..rows * columns], rows, columns)
}

/// Views a column-major slice for writing.
pub(crate) fn view_mut(values: &mut [f64], rows: usize, columns: usize) -> MatMut<'_, f64> {
    MatMut::from_column_major_slice_mut(&mut values[..rows * columns], rows, columns)
}

/// Runs `work` on every item, on several threads when there is enough to do.
pub(crate) fn for_each<T: Send>(parallel: bool, mut items: Vec<T>, work: impl Fn(&mut T) + Sync) {
    let length = if parallel { 1 } else { items.len().max(1) };
    parallel::each_mut(&mut items, length, |_, item| work(item));
}

fn row_tiles<'a>(mut matrix: MatMut<'a, f64>, tile: usize) -> Vec<(usize, MatMut<'a, f64>)> {
    let mut tiles = Vec::with_capacity(matrix.nrows().div_ceil(tile));
    let mut at = 0;
    while matrix.nrows() > 0 {
        let (head, tail) = {
            let rows = tile.min(matrix.nrows());
            matrix.split_at_row_mut(rows)
        };
        let rows = head.nrows();
        tiles.push((at, head));
        at += rows;
        matrix = tail;
    }
    tiles
}

fn column_tiles<'a>(mut matrix: MatMut<'a, f64>, tile: usize) -> Vec<(usize, MatMut<'a, f64>)> {
    let mut tiles = Vec::with_capacity(matrix.ncols().div_ceil(tile));
    let mut at = 0;
    while matrix.ncols() > 0 {
        let (head, tail) = {
            let columns = tile.min(matrix.ncols());
            matrix.split_at_col_mut(columns)
        };
        let columns = head.ncols();
        tiles.push((at, head));
        at += columns;
        matrix = tail;
    }
    tiles
}

/// `target -= left * right`.
pub(crate) fn subtract_product(target: MatMut<'_, f64>, left: MatRef<'_, f64>, right: MatRef<'_, f64>) {
    matmul(target, Accum::Add, left, right, -1.0, Par::Seq);
}

/// Cholesky of the first `pivots` columns of a symmetric front of `order` rows, of which `panel` holds the lower part.
///
/// # Errors
/// The first pivot, from 0, that is not positive.
pub(crate) fn cholesky_panel(panel: &mut [f64], order: usize, pivots: usize) -> Result<(), usize> {
    let mut memory = MemBuffer::new(cholesky_in_place_scratch::<f64>(BLOCK, Par::Seq, Default::default()));
    let mut k = 0;
    while k < pivots {
        let width = BLOCK.min(pivots - k);
        let (left, right) = panel.split_at_mut(order * k);
        let left = view(left, order, k).subrows(k, order - k);
        let (mut head, mut below) = view_mut(right, order, width).subrows_mut(k, order - k).split_at_row_mut(width);
        let (left_head, left_below) = left.split_at_row(width);
        if k > 0 {
            triangular::matmul(
                head.as_mut(),
                BlockStructure::TriangularLower,
                Accum::Add,
                left_head,
                BlockStructure::Rectangular,
                left_head.transpose(),
                BlockStructure::Rectangular,
                -1.0,
                Par::Seq,
            );
        }
        cholesky_in_place(head.as_mut(), Default::default(), Par::Seq, MemStack::new(&mut memory), Default::default())
            .map_err(|LltError::NonPositivePivot { index }| k + index)?;
        let head = head.as_ref();
        let parallel = below.nrows() * width * (k + width) > PARALLEL_WORK;
        for_each(parallel, row_tiles(below.as_mut(), ROW_TILE), |(at, tile)| {
            if k > 0 {
                let rows = tile.nrows();
                subtract_product(tile.as_mut(), left_below.subrows(*at, rows), left_head.transpose());
            }
            solve_lower_triangular_in_place(head, tile.as_mut().transpose_mut(), Par::Seq);
        });
        k += width;
    }
    Ok(())
}

/// Lower part of `update = -below nearᵀ`, where `near` are the first `width` rows of `below`.
pub(crate) fn symmetric_update(update: &mut [f64], below: MatRef<'_, f64>, width: usize) {
    let (diagonal, lower) = view_mut(update, below.nrows(), width).split_at_row_mut(width);
    let (near, far) = below.split_at_row(width);
    triangular::matmul(
        diagonal,
        BlockStructure::TriangularLower,
        Accum::Replace,
        near,
        BlockStructure::Rectangular,
        near.transpose(),
        BlockStructure::Rectangular,
        -1.0,
        Par::Seq,
    );
    matmul(lower, Accum::Replace, far, near.transpose(), -1.0, Par::Seq);
}

/// `update = -left right`.
pub(crate) fn general_update(update: MatMut<'_, f64>, left: MatRef<'_, f64>, right: MatRef<'_, f64>) {
    matmul(update, Accum::Replace, left, right, -1.0, Par::Seq);
}

/// `matrix = matrix U⁻¹` with `U` the upper triangle of `factor`, in tiles of rows.
pub(crate) fn solve_upper_from_right(matrix: MatMut<'_, f64>, factor: MatRef<'_, f64>) {
    let work = matrix.nrows() * matrix.ncols() * matrix.ncols();
    for_each(work > PARALLEL_WORK, row_tiles(matrix, ROW_TILE), |(_, tile)| {
        solve_lower_triangular_in_place(factor.transpose(), tile.as_mut().transpose_mut(), Par::Seq);
    });
}

/// `matrix = L⁻¹ matrix` with `L` the unit lower triangle of `factor`, in tiles of columns.
pub(crate) fn solve_unit_lower(matrix: MatMut<'_, f64>, factor: MatRef<'_, f64>) {
    let work = matrix.nrows() * matrix.nrows() * matrix.ncols();
    for_each(work > PARALLEL_WORK, column_tiles(matrix, COLUMN_TILE), |(_, tile)| {
        solve_unit_lower_triangular_in_place(factor, tile.as_mut(), Par::Seq);
    });
}

/// Columns solved at once in a triangular solve with a vector.
const VECTOR_BLOCK: usize = 192;
/// Rows or columns of one task of a matrix–vector product.
const VECTOR_TILE: usize = 512;

/// Solves with the unit lower triangle of a square factor.
pub(crate) fn forward(square: MatRef<'_, f64>, local: &mut [f64]) {
    let order = square.ncols();
    let mut k = 0;
    while k < order {
        let width = VECTOR_BLOCK.min(order - k);
        let (head, below) = square.submatrix(k, k, order - k, width).split_at_row(width);
        let (x, rest) = local[k..order].split_at_mut(width);
        let mut x = view_mut(x, width, 1);
        solve_unit_lower_triangular_in_place(head, x.as_mut(), Par::Seq);
        subtract_from_vector(rest, below, x.as_ref());
        k += width;
    }
}

/// `target -= matrix x`.
fn subtract_from_vector(target: &mut [f64], matrix: MatRef<'_, f64>, x: MatRef<'_, f64>) {
    let rows = target.len();
    let tiles = row_tiles(view_mut(target, rows, 1), VECTOR_TILE);
    for_each(rows * matrix.ncols() > PARALLEL_WORK / 8, tiles, |(at, tile)| {
        let count = tile.nrows();
        subtract_product(tile.as_mut(), matrix.subrows(*at, count), x);
    });
}

/// Solves with the upper triangle of a square factor.
pub(crate) fn backward_upper(square: MatRef<'_, f64>, x: &mut [f64]) {
    let mut end = square.ncols();
    while end > 0 {
        let start = (end - 1) / VECTOR_BLOCK * VECTOR_BLOCK;
        let (above, block) = square.submatrix(0, start, end, end - start).split_at_row(start);
        let (before, x) = x[..end].split_at_mut(start);
        let mut x = view_mut(x, end - start, 1);
        solve_upper_triangular_in_place(block, x.as_mut(), Par::Seq);
        if start > 0 {
            subtract_from_vector(before, above, x.as_ref());
        }
        end = start;
    }
}
