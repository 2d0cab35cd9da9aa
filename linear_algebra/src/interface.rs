//! The dense system of the interface: the bulk's Schur complement plus the coupling.

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
    /// Factorises a column-major matrix of order `n`.
    pub(crate) fn new(mut values: Vec<f64>, n: usize) -> Self {
        let scaling = equilibrate::dense(&mut values, n);
        let pivots = dense_lu::factorise(&mut values, n, PIVOT_LIMIT);
        Self { order: n, values, pivots, scaling }
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
        let m = kept.len();
        let mut values = reuse.map_or_else(Vec::new, |old| old.factor.into_values());
        values.clear();
        values.reserve_exact(m * m);
        for &column in &kept {
            let column = &schur[n * column as usize..n * (column as usize + 1)];
            if m == n {
                values.extend_from_slice(column);
            } else {
                values.extend(kept.iter().map(|&row| column[row as usize]));
            }
        }
        if let Some(coupling) = coupling {
            for (at, &i) in equations.iter().enumerate() {
                let (columns, entries) = coupling.row(i as usize);
                for (&j, &value) in columns.iter().zip(entries).filter(|(_, value)| **value != 0.0) {
                    let column = local(j);
                    match &mut lone_of[column] {
                        Some(lone) if column != at => lone.others.push((at as u32, value)),
                        Some(_) => {}
                        None => values[dense_index[at] as usize + m * dense_index[column] as usize] += value,
                    }
                }
            }
        }
        Self { lone: lone_of.into_iter().flatten().collect(), kept, factor: DenseFactor::new(values, m) }
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
