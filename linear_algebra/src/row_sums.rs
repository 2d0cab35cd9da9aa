//! Products of rows of a matrix with a vector.
//!
//! Entries are added in one order, so that processors with wider vectors give the same bits, sooner.

use crate::prefetch::{AHEAD, prefetch, prefetch_as_many};

/// Products added side by side, which hides the time that an addition takes.
const LANES: usize = 8;
/// Entries of the vector that are gathered at a time.
const GATHERED: usize = 96;
/// Products of rows between one whose columns are read and the one whose columns are asked for.
const PRODUCTS_AHEAD: usize = 4;

/// Room for gathered entries, reused row after row.
pub(crate) type Gathered = [f64; GATHERED];

/// Room for the entries of a vector.
pub(crate) const NOTHING_GATHERED: Gathered = [0.0; GATHERED];

/// `Σ_j a_j x_j` of rows with the same columns. Columns and entries of one matrix are asked for ahead of the rows that follow.
#[inline]
pub(crate) fn row_sums<const R: usize>(
    columns: &[u32],
    rows: [&[f64]; R],
    x: &[f64],
    gathered: &mut Gathered,
) -> [f64; R] {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the processor has just said that it knows AVX2.
        return unsafe { row_sums_by_avx2(columns, rows, x, gathered) };
    }
    row_sums_in(columns, rows, x, gathered)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn row_sums_by_avx2<const R: usize>(
    columns: &[u32],
    rows: [&[f64]; R],
    x: &[f64],
    gathered: &mut Gathered,
) -> [f64; R] {
    row_sums_in(columns, rows, x, gathered)
}

#[inline(always)]
fn row_sums_in<const R: usize>(columns: &[u32], rows: [&[f64]; R], x: &[f64], gathered: &mut Gathered) -> [f64; R] {
    prefetch_as_many(columns, PRODUCTS_AHEAD * R * size_of_val(columns));
    let mut sums = [[0.0; LANES]; R];
    for (batch, columns) in columns.chunks(GATHERED).enumerate() {
        let gathered = &mut gathered[..columns.len()];
        gathered.iter_mut().zip(columns).for_each(|(to, &column)| *to = x[column as usize]);
        for (sums, row) in sums.iter_mut().zip(rows) {
            let row = &row[batch * GATHERED..][..columns.len()];
            let (row, x) = (row.chunks_exact(LANES), gathered.chunks_exact(LANES));
            let rest = row.remainder().iter().zip(x.remainder());
            for (sum, (a, x)) in sums.iter_mut().zip(rest) {
                *sum += a * x;
            }
            for (a, x) in row.zip(x) {
                prefetch(a, AHEAD);
                (0..LANES).for_each(|lane| sums[lane] += a[lane] * x[lane]);
            }
        }
    }
    sums.map(|[a, b, c, d, e, f, g, h]| ((a + b) + (c + d)) + ((e + f) + (g + h)))
}
