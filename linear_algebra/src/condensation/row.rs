//! A sparse row that is summed up of others.

use super::NONE;
use crate::csr::Csr;
use crate::system::System;

/// A row under way: values by column, and which columns it has.
pub(super) struct SparseRow {
    values: Vec<f64>,
    is_there: Vec<bool>,
    columns: Vec<u32>,
}

impl SparseRow {
    /// An empty row over this many columns.
    pub(super) fn new(columns: usize) -> Self {
        Self { values: vec![0.0; columns], is_there: vec![false; columns], columns: Vec::new() }
    }

    /// Adds multiples of terms.
    pub(super) fn add(&mut self, terms: &[(u32, f64)], factor: f64) {
        for &(column, value) in terms {
            let at = column as usize;
            if !self.is_there[at] {
                self.is_there[at] = true;
                self.columns.push(column);
            }
            self.values[at] += factor * value;
        }
    }

    /// Adds the part of an equation that is no multiplier's, and hands on the rest.
    pub(super) fn add_equation(
        &mut self,
        system: &System<'_>,
        equation: usize,
        factor: f64,
        left: &[u32],
        mut multiplier: impl FnMut(usize, f64),
    ) {
        if factor == 0.0 {
            return;
        }
        for (j, value) in system.row(equation) {
            if left[j] == NONE {
                multiplier(j, factor * value);
            } else {
                self.add(&[(left[j], value)], factor);
            }
        }
    }

    /// The terms in the order of columns; the row is empty then.
    pub(super) fn take(&mut self) -> Vec<(u32, f64)> {
        self.columns.sort_unstable();
        let terms = self.columns.iter().map(|&column| (column, self.values[column as usize])).collect();
        for column in self.columns.drain(..) {
            self.values[column as usize] = 0.0;
            self.is_there[column as usize] = false;
        }
        terms
    }

    /// Appends the row, with its diagonal, to a matrix; the row is empty then.
    pub(super) fn finish(&mut self, matrix: &mut Csr, at: usize) {
        self.add(&[(at as u32, 0.0)], 1.0);
        for (column, value) in self.take() {
            matrix.columns.push(column);
            matrix.values.push(value);
        }
        matrix.row_starts[at + 1] = matrix.columns.len();
    }
}
