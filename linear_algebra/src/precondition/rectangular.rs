//! Sparse matrices that need not be square, and their products.

use rayon::prelude::*;

use crate::csr::Csr;

/// Rows of a task; fixed, so that results do not depend on the number of threads.
const ROWS_PER_TASK: usize = 256;

/// Matrices whose rows can be read.
pub(super) trait Rows: Sync {
    fn rows(&self) -> usize;
    fn row(&self, i: usize) -> (&[u32], &[f64]);
}

impl Rows for Csr {
    fn rows(&self) -> usize {
        self.rows
    }

    fn row(&self, i: usize) -> (&[u32], &[f64]) {
        Csr::row(self, i)
    }
}

/// A sparse matrix by rows with ascending columns.
#[derive(Debug, Clone)]
pub(super) struct Rectangular {
    pub(super) columns: usize,
    pub(super) starts: Vec<usize>,
    pub(super) indices: Vec<u32>,
    pub(super) values: Vec<f64>,
}

impl Rows for Rectangular {
    fn rows(&self) -> usize {
        self.starts.len() - 1
    }

    fn row(&self, i: usize) -> (&[u32], &[f64]) {
        let range = self.starts[i]..self.starts[i + 1];
        (&self.indices[range.clone()], &self.values[range])
    }
}

impl Rectangular {
    fn from_rows(columns: usize, rows: Vec<Vec<(u32, f64)>>) -> Self {
        let entries = rows.iter().map(Vec::len).sum();
        let mut matrix = Self {
            columns,
            starts: Vec::with_capacity(rows.len() + 1),
            indices: Vec::with_capacity(entries),
            values: Vec::with_capacity(entries),
        };
        matrix.starts.push(0);
        for row in rows {
            matrix.indices.extend(row.iter().map(|&(j, _)| j));
            matrix.values.extend(row.iter().map(|&(_, value)| value));
            matrix.starts.push(matrix.indices.len());
        }
        matrix
    }

    /// `y = y + M x`.
    pub(super) fn mul_vec_add(&self, x: &[f64], y: &mut [f64]) {
        y.par_iter_mut().enumerate().with_min_len(ROWS_PER_TASK).for_each(|(i, y)| {
            let (columns, values) = self.row(i);
            *y += columns.iter().zip(values).map(|(&j, a)| a * x[j as usize]).sum::<f64>();
        });
    }

    pub(super) fn transpose(&self) -> Self {
        let mut starts = vec![0; self.columns + 1];
        for &j in &self.indices {
            starts[j as usize + 1] += 1;
        }
        for j in 0..self.columns {
            starts[j + 1] += starts[j];
        }
        let mut next = starts.clone();
        let mut transposed = Self {
            columns: self.rows(),
            starts,
            indices: vec![0; self.indices.len()],
            values: vec![0.0; self.values.len()],
        };
        for i in 0..self.rows() {
            let (columns, values) = self.row(i);
            for (&j, &value) in columns.iter().zip(values) {
                let at = &mut next[j as usize];
                transposed.indices[*at] = i as u32;
                transposed.values[*at] = value;
                *at += 1;
            }
        }
        transposed
    }

    /// The matrix as a square one.
    pub(super) fn into_csr(self) -> Csr {
        Csr { rows: self.rows(), row_starts: self.starts, columns: self.indices, values: self.values }
    }
}

/// `left right`, with row `i` then passed through `finish`.
pub(super) fn product(
    left: &impl Rows,
    right: &Rectangular,
    finish: impl Fn(usize, &mut Vec<(u32, f64)>) + Sync,
) -> Rectangular {
    let rows = (0..left.rows())
        .into_par_iter()
        .with_min_len(ROWS_PER_TASK)
        .map_init(
            || vec![u32::MAX; right.columns],
            |place, i| {
                let mut row: Vec<(u32, f64)> = Vec::new();
                let (columns, values) = left.row(i);
                for (&k, &a) in columns.iter().zip(values) {
                    let (columns, values) = right.row(k as usize);
                    for (&j, &b) in columns.iter().zip(values) {
                        let at = &mut place[j as usize];
                        if *at == u32::MAX {
                            *at = row.len() as u32;
                            row.push((j, a * b));
                        } else {
                            row[*at as usize].1 += a * b;
                        }
                    }
                }
                row.iter().for_each(|&(j, _)| place[j as usize] = u32::MAX);
                finish(i, &mut row);
                row.sort_unstable_by_key(|&(j, _)| j);
                row
            },
        )
        .collect();
    Rectangular::from_rows(right.columns, rows)
}

/// A matrix with these rows, each with ascending columns.
pub(super) fn from_rows(columns: usize, rows: Vec<Vec<(u32, f64)>>) -> Rectangular {
    Rectangular::from_rows(columns, rows)
}
