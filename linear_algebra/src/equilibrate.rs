//! Scale factors that bring the largest entry of every row and column near one.

use crate::csr::Csr;
use crate::multifrontal::Scaling;

/// Rounds of scaling; each takes the square root of the remaining factor.
const ROUNDS: usize = 3;

/// The power of two nearest to `1 / sqrt(largest)`, so that scaling is exact; one for an empty row.
fn factor(largest: f64) -> f64 {
    if largest > 0.0 && largest.is_finite() { 2.0_f64.powi((-0.5 * largest.log2()).round() as i32) } else { 1.0 }
}

/// Row and column factors of a matrix.
pub(crate) fn factors(matrix: &Csr) -> Scaling {
    let n = matrix.rows;
    let mut scaling = Scaling { row: vec![1.0; n], column: vec![1.0; n] };
    for _ in 0..ROUNDS {
        let mut rows = vec![0.0_f64; n];
        let mut columns = vec![0.0_f64; n];
        for i in 0..n {
            let (at, values) = matrix.row(i);
            for (&j, value) in at.iter().zip(values) {
                let size = (value * scaling.row[i] * scaling.column[j as usize]).abs();
                rows[i] = rows[i].max(size);
                columns[j as usize] = columns[j as usize].max(size);
            }
        }
        scaling.row.iter_mut().zip(&rows).for_each(|(scale, &largest)| *scale *= factor(largest));
        scaling.column.iter_mut().zip(&columns).for_each(|(scale, &largest)| *scale *= factor(largest));
    }
    scaling
}

/// Factors that bring the diagonal of a symmetric positive definite matrix near one.
pub(crate) fn of_diagonal(matrix: &Csr) -> Scaling {
    let row: Vec<f64> = matrix.diagonal().into_iter().map(factor).collect();
    Scaling { column: row.clone(), row }
}
