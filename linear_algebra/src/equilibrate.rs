//! Scale factors that bring the largest entry of every row and column near one.

use rayon::prelude::*;

use crate::csr::Csr;
use crate::multifrontal::Scaling;

/// Rounds of scaling; each takes the square root of what the one before left.
const ROUNDS: usize = 3;

/// The power of two nearest to `1 / sqrt(largest)`, so that scaling is exact; one for an empty row.
fn factor(largest: f64) -> f64 {
    if largest > 0.0 && largest.is_finite() { 2.0_f64.powi((-0.5 * largest.log2()).round() as i32) } else { 1.0 }
}

/// Row and column factors of a sparse matrix.
pub(crate) fn sparse(matrix: &Csr) -> Scaling {
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

/// Scales a dense column-major matrix of order `n` in place and gives the factors.
pub(crate) fn dense(values: &mut [f64], n: usize) -> Scaling {
    let mut scaling = Scaling { row: vec![1.0; n], column: vec![1.0; n] };
    if n == 0 {
        return scaling;
    }
    let chunk = n * 64;
    for _ in 0..ROUNDS {
        let measured: Vec<(Vec<f64>, Vec<f64>)> = values
            .par_chunks(chunk)
            .map(|block| {
                let mut rows = vec![0.0_f64; n];
                let mut columns = Vec::with_capacity(64);
                for column in block.chunks(n) {
                    let mut largest = 0.0_f64;
                    for (row, value) in rows.iter_mut().zip(column) {
                        *row = row.max(value.abs());
                        largest = largest.max(value.abs());
                    }
                    columns.push(largest);
                }
                (rows, columns)
            })
            .collect();
        let mut rows = vec![0.0_f64; n];
        for (part, _) in &measured {
            rows.iter_mut().zip(part).for_each(|(row, part)| *row = row.max(*part));
        }
        let rows: Vec<f64> = rows.into_iter().map(factor).collect();
        let columns: Vec<f64> = measured.into_iter().flat_map(|(_, columns)| columns).map(factor).collect();
        values.par_chunks_mut(chunk).zip(columns.par_chunks(64)).for_each(|(block, columns)| {
            for (column, &scale) in block.chunks_mut(n).zip(columns) {
                column.iter_mut().zip(&rows).for_each(|(value, row)| *value *= row * scale);
            }
        });
        scaling.row.iter_mut().zip(&rows).for_each(|(scale, factor)| *scale *= factor);
        scaling.column.iter_mut().zip(&columns).for_each(|(scale, factor)| *scale *= factor);
    }
    scaling
}
