//! Incomplete LU without fill.

use super::Precondition;
use crate::csr::Csr;

/// Factors on the pattern of the matrix: unit `L` below the diagonal, `U` on and above it.
pub(crate) struct Ilu0 {
    factors: Csr,
    /// Place of each diagonal entry.
    diagonal: Vec<usize>,
}

/// Pivots below this share of their row are lifted to it.
const PIVOT_SHARE: f64 = 1e-8;

impl Ilu0 {
    /// Factorises `matrix` row by row.
    pub(crate) fn new(matrix: &Csr) -> Self {
        let n = matrix.rows;
        let missing = (0..n).any(|i| matrix.find(i, i).is_none());
        let unit: Vec<(usize, usize, f64)> = if missing { (0..n).map(|i| (i, i, 0.0)).collect() } else { Vec::new() };
        let mut factors = if missing { matrix.plus(&Csr::from_triplets(n, &unit)) } else { matrix.with_own_columns() };
        let diagonal: Vec<usize> = (0..n).map(|i| factors.find(i, i).expect("the diagonal was added")).collect();
        let mut place = vec![usize::MAX; n];
        for i in 0..n {
            let row = factors.row_starts[i]..factors.row_starts[i + 1];
            let mut size = 0.0_f64;
            for at in row.clone() {
                place[factors.columns[at] as usize] = at;
                size = size.max(factors.values[at].abs());
            }
            for at in row.start..diagonal[i] {
                let k = factors.columns[at] as usize;
                let factor = factors.values[at] / factors.values[diagonal[k]];
                factors.values[at] = factor;
                for upper in diagonal[k] + 1..factors.row_starts[k + 1] {
                    let target = place[factors.columns[upper] as usize];
                    if target != usize::MAX {
                        factors.values[target] -= factor * factors.values[upper];
                    }
                }
            }
            let pivot = &mut factors.values[diagonal[i]];
            let least = if size > 0.0 { PIVOT_SHARE * size } else { 1.0 };
            if pivot.abs() < least {
                *pivot = least.copysign(*pivot);
            }
            row.for_each(|at| place[factors.columns[at] as usize] = usize::MAX);
        }
        Self { factors, diagonal }
    }
}

impl Precondition for Ilu0 {
    fn apply(&self, x: &mut [f64]) {
        let sum = |range: std::ops::Range<usize>, x: &[f64]| -> f64 {
            let columns = &self.factors.columns[range.clone()];
            columns.iter().zip(&self.factors.values[range]).map(|(&j, a)| a * x[j as usize]).sum()
        };
        for i in 0..x.len() {
            x[i] -= sum(self.factors.row_starts[i]..self.diagonal[i], x);
        }
        for i in (0..x.len()).rev() {
            let known = sum(self.diagonal[i] + 1..self.factors.row_starts[i + 1], x);
            x[i] = (x[i] - known) / self.factors.values[self.diagonal[i]];
        }
    }
}
