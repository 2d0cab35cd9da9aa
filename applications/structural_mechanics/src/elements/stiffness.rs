//! The product that tangents of solids are made of, `Σ Bᵀ (w D B)` over the points of an element.
//!
//! Loops have fixed lengths and add in one order, so that processors with wider vectors give the same bits, sooner.

use crate::laws::Matrix;

/// Rows and columns of a tile, whose sums stay in registers.
const TILE: usize = 4;

/// Adds `Σ_s aᵀ_s rows_s` to `out`, tile by tile; of the entries left of the diagonal only those of its tiles, unless `whole`.
#[inline(always)]
fn add_product<const S: usize, const M: usize, const N: usize>(
    a: &[[f64; M]; S],
    rows: &[[f64; N]; S],
    whole: bool,
    out: &mut [[f64; N]; M],
) {
    let mut column = 0;
    while column + TILE <= N {
        add_columns::<TILE, S, M, N>(a, rows, column, whole, out);
        column += TILE;
    }
    for column in column..N {
        add_columns::<1, S, M, N>(a, rows, column, whole, out);
    }
}

/// `W` columns of the product.
#[inline(always)]
fn add_columns<const W: usize, const S: usize, const M: usize, const N: usize>(
    a: &[[f64; M]; S],
    rows: &[[f64; N]; S],
    column: usize,
    whole: bool,
    out: &mut [[f64; N]; M],
) {
    let part: [[f64; W]; S] = std::array::from_fn(|s| std::array::from_fn(|w| rows[s][column + w]));
    let end = if whole { M } else { M.min(column + W) };
    let mut row = 0;
    while row + TILE <= end {
        add_tile::<TILE, W, S, M, N>(a, &part, [row, column], out);
        row += TILE;
    }
    for row in row..end {
        add_tile::<1, W, S, M, N>(a, &part, [row, column], out);
    }
}

/// `R` rows of them.
#[inline(always)]
fn add_tile<const R: usize, const W: usize, const S: usize, const M: usize, const N: usize>(
    a: &[[f64; M]; S],
    part: &[[f64; W]; S],
    [row, column]: [usize; 2],
    out: &mut [[f64; N]; M],
) {
    let mut sums: [[f64; W]; R] = std::array::from_fn(|r| std::array::from_fn(|w| out[row + r][column + w]));
    for (a, part) in a.iter().zip(part) {
        for (r, sums) in sums.iter_mut().enumerate() {
            (0..W).for_each(|w| sums[w] += a[row + r] * part[w]);
        }
    }
    sums.iter().zip(&mut out[row..]).for_each(|(sums, out)| out[column..column + W].copy_from_slice(sums));
}

#[inline(always)]
fn add<const S: usize, const SIZE: usize>(
    weight: f64,
    d: &Matrix<S>,
    b: &[[f64; SIZE]; S],
    whole: bool,
    out: &mut [[f64; SIZE]; SIZE],
) {
    let mut transposed = [[0.0; S]; S];
    for s in 0..S {
        (0..S).for_each(|row| transposed[s][row] = weight * d[row][s]);
    }
    let mut db = [[0.0; SIZE]; S];
    add_product(&transposed, b, true, &mut db);
    add_product(b, &db, whole, out);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn add_by_avx2<const S: usize, const SIZE: usize>(
    weight: f64,
    d: &Matrix<S>,
    b: &[[f64; SIZE]; S],
    whole: bool,
    out: &mut [[f64; SIZE]; SIZE],
) {
    add(weight, d, b, whole, out);
}

/// Adds `weight Bᵀ D B`; entries left of the diagonal only hold it where `whole` asks for them.
pub(super) fn add_stiffness<const S: usize, const SIZE: usize>(
    weight: f64,
    d: &Matrix<S>,
    b: &[[f64; SIZE]; S],
    whole: bool,
    out: &mut [[f64; SIZE]; SIZE],
) {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the processor has just said that it knows AVX2.
        unsafe { add_by_avx2(weight, d, b, whole, out) };
        return;
    }
    add(weight, d, b, whole, out);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_product_is_the_sum_of_its_terms_to_the_bit() {
        const SIZE: usize = 10;
        let number = |k: usize| (1.7 * k as f64).sin();
        let b: [[f64; SIZE]; 3] = std::array::from_fn(|s| std::array::from_fn(|c| number(s * SIZE + c)));
        let d: Matrix<3> = std::array::from_fn(|s| std::array::from_fn(|k| number(50 + 3 * s + k)));
        for whole in [false, true] {
            let mut out = [[0.5; SIZE]; SIZE];
            add_stiffness(0.3, &d, &b, whole, &mut out);
            for r in 0..SIZE {
                for c in if whole { 0 } else { r }..SIZE {
                    let mut expected = 0.5;
                    for s in 0..3 {
                        expected += b[s][r] * (0..3).fold(0.0, |sum, k| sum + 0.3 * d[s][k] * b[k][c]);
                    }
                    assert_eq!(out[r][c], expected, "{r} {c}");
                }
            }
        }
    }
}
