//! The product that tangents of solids are made of, `Σ Bᵀ (w D B)` over the points of an element.
//!
//! Loops have fixed lengths and add in one order, so that processors with wider vectors give the same bits, sooner.

use crate::laws::Matrix;

/// Entries of a row that are added side by side.
const LANES: usize = 4;

/// `w D B`, row by row.
#[inline(always)]
fn weighted<const S: usize, const SIZE: usize>(weight: f64, d: &Matrix<S>, b: &[[f64; SIZE]; S]) -> [[f64; SIZE]; S] {
    let mut out = [[0.0; SIZE]; S];
    for (row, d) in out.iter_mut().zip(d) {
        add_rows(&d.map(|d| weight * d), b, 0, row);
    }
    out
}

/// Adds `Σ_s factors[s] rows[s]` to `out`, from the entry `first` on, rounded down to whole lanes.
#[inline(always)]
fn add_rows<const S: usize, const SIZE: usize>(
    factors: &[f64; S],
    rows: &[[f64; SIZE]; S],
    first: usize,
    out: &mut [f64; SIZE],
) {
    let mut at = first / LANES * LANES;
    while at + LANES <= SIZE {
        let mut sums: [f64; LANES] = out[at..at + LANES].try_into().expect("whole lanes");
        for (factor, row) in factors.iter().zip(rows) {
            (0..LANES).for_each(|lane| sums[lane] += factor * row[at + lane]);
        }
        out[at..at + LANES].copy_from_slice(&sums);
        at += LANES;
    }
    for at in at..SIZE {
        factors.iter().zip(rows).for_each(|(factor, row)| out[at] += factor * row[at]);
    }
}

#[inline(always)]
fn add<const S: usize, const SIZE: usize>(
    weight: f64,
    d: &Matrix<S>,
    b: &[[f64; SIZE]; S],
    whole: bool,
    out: &mut [[f64; SIZE]; SIZE],
) {
    let db = weighted(weight, d, b);
    for (r, row) in out.iter_mut().enumerate() {
        add_rows(&b.map(|b| b[r]), &db, if whole { 0 } else { r }, row);
    }
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
