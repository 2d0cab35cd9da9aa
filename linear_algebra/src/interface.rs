//! The dense system of the interface: the bulk's Schur complement plus the coupling.

use rayon::prelude::*;

use crate::csr::Csr;
use crate::dense_lu::{self, Pivots};
use crate::equilibrate;
use crate::multifrontal::Scaling;

/// Pivots of the equilibrated matrix below this are replaced and reported.
const PIVOT_LIMIT: f64 = 1e-14;

/// A factorised dense matrix `diag(row)⁻¹ L U diag(column)⁻¹`.
pub(crate) struct DenseFactor {
    order: usize,
    values: Vec<f64>,
    pivots: Pivots,
    scaling: Scaling,
}

impl DenseFactor {
    /// Factorises a column-major matrix that is scaled already.
    pub(crate) fn new(mut values: Vec<f64>, scaling: Scaling) -> Self {
        let order = scaling.row.len();
        let pivots = dense_lu::factorise(&mut values, order, PIVOT_LIMIT);
        Self { order, values, pivots, scaling }
    }

    /// Replaces `x` by the solution.
    pub(crate) fn solve(&self, x: &mut [f64]) {
        x.iter_mut().zip(&self.scaling.row).for_each(|(x, scale)| *x *= scale);
        dense_lu::solve(&self.values, self.order, &self.pivots, x);
        x.iter_mut().zip(&self.scaling.column).for_each(|(x, scale)| *x *= scale);
    }

    /// Whether a pivot was so small that it was replaced.
    pub(crate) fn is_suspicious(&self) -> bool {
        !self.pivots.replaced.is_empty()
    }

    /// The memory, for the next factorisation.
    fn into_values(self) -> Vec<f64> {
        self.values
    }
}

/// An equation that knows only itself, `diagonal x = b`, and the other equations that know it.
struct Lone {
    at: u32,
    diagonal: f64,
    others: Vec<(u32, f64)>,
}

/// The factorised interface system; lone equations (inactive multipliers) are kept out of the dense block.
pub(crate) struct Interface {
    lone: Vec<Lone>,
    /// Local index of each equation of the dense block.
    kept: Vec<u32>,
    factor: DenseFactor,
}

impl Interface {
    /// Factorises `schur` (column-major, order of `equations`) plus the entries of `coupling` among `equations`.
    ///
    /// `local` gives the index in `equations` of each equation of the whole system, `in_bulk` whether the bulk knows
    /// the equation; `reuse` gives its memory.
    pub(crate) fn new(
        schur: &[f64],
        equations: &[u32],
        coupling: Option<&Csr>,
        local: impl Fn(u32) -> usize,
        in_bulk: impl Fn(u32) -> bool,
        reuse: Option<Interface>,
    ) -> Self {
        let n = equations.len();
        let mut lone_of: Vec<Option<Lone>> = (0..n).map(|_| None).collect();
        if let Some(coupling) = coupling {
            for (at, &i) in equations.iter().enumerate() {
                let (columns, values) = coupling.row(i as usize);
                let mut entries = columns.iter().zip(values).filter(|(_, value)| **value != 0.0);
                if let (Some((&j, &diagonal)), None) = (entries.next(), entries.next())
                    && j == i
                    && !in_bulk(i)
                {
                    lone_of[at] = Some(Lone { at: at as u32, diagonal, others: Vec::new() });
                }
            }
        }
        let kept: Vec<u32> = (0..n as u32).filter(|&at| lone_of[at as usize].is_none()).collect();
        let mut dense_index = vec![u32::MAX; n];
        for (index, &at) in kept.iter().enumerate() {
            dense_index[at as usize] = index as u32;
        }
        let mut entries = Vec::new();
        if let Some(coupling) = coupling {
            for (at, &i) in equations.iter().enumerate() {
                let (columns, values) = coupling.row(i as usize);
                for (&j, &value) in columns.iter().zip(values).filter(|(_, value)| **value != 0.0) {
                    let column = local(j);
                    match &mut lone_of[column] {
                        Some(lone) if column != at => lone.others.push((at as u32, value)),
                        Some(_) => {}
                        None => entries.push((dense_index[at] as usize, dense_index[column] as usize, value)),
                    }
                }
            }
        }
        let scaling = scaling(schur, n, &kept, &entries);
        let m = kept.len();
        let mut values = reuse.map_or_else(Vec::new, |old| old.factor.into_values());
        values.resize(m * m, 0.0);
        values.par_chunks_mut(m.max(1)).zip(&kept).zip(&scaling.column).with_min_len(16).for_each(
            |((target, &column), column_scale)| {
                let source = &schur[n * column as usize..n * (column as usize + 1)];
                for ((value, &row), row_scale) in target.iter_mut().zip(&kept).zip(&scaling.row) {
                    *value = source[row as usize] * row_scale * column_scale;
                }
            },
        );
        for &(i, j, value) in &entries {
            values[i + m * j] += value * scaling.row[i] * scaling.column[j];
        }
        Self { lone: lone_of.into_iter().flatten().collect(), kept, factor: DenseFactor::new(values, scaling) }
    }

    /// Replaces `x`, in the order of the interface, by the solution.
    pub(crate) fn solve(&self, x: &mut [f64]) {
        for lone in &self.lone {
            x[lone.at as usize] /= lone.diagonal;
        }
        for lone in &self.lone {
            let value = x[lone.at as usize];
            for &(at, entry) in &lone.others {
                x[at as usize] -= entry * value;
            }
        }
        let mut dense: Vec<f64> = self.kept.iter().map(|&at| x[at as usize]).collect();
        self.factor.solve(&mut dense);
        for (&at, value) in self.kept.iter().zip(dense) {
            x[at as usize] = value;
        }
    }

    /// Whether the dense block is nearly singular.
    pub(crate) fn is_suspicious(&self) -> bool {
        self.factor.is_suspicious()
    }
}

/// Scale factors of the equations `kept` of a Schur complement plus sparse `entries`.
///
/// The diagonal stands for the whole Schur complement, since no entry of a positive definite matrix exceeds the
/// geometric mean of its diagonal entries; that spares passes over the dense matrix.
fn scaling(schur: &[f64], n: usize, kept: &[u32], entries: &[(usize, usize, f64)]) -> Scaling {
    let diagonal = kept.iter().enumerate().map(|(at, &i)| (at, at, schur[i as usize * (n + 1)]));
    let sample: Vec<(usize, usize, f64)> = diagonal.chain(entries.iter().copied()).collect();
    equilibrate::factors(&Csr::from_triplets(kept.len(), &sample))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lone_equations_are_solved_apart() {
        let schur = [4.0, 1.0, 0.0, 1.0, 3.0, 0.0, 0.0, 0.0, 0.0];
        let coupling = Csr::from_triplets(3, &[(0, 2, 5.0), (2, 2, -2.0)]);
        let interface = Interface::new(&schur, &[0, 1, 2], Some(&coupling), |j| j as usize, |j| j < 2, None);
        assert_eq!((interface.lone.len(), interface.kept.len()), (1, 2));
        let mut x = [4.0 + 2.0 - 15.0, 1.0 + 6.0, 6.0];
        interface.solve(&mut x);
        for (x, exact) in x.iter().zip([1.0, 2.0, -3.0]) {
            assert!((x - exact).abs() < 1e-14);
        }
    }
}
