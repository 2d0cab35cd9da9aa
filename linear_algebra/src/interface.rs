//! The dense system of the interface: the bulk's Schur complement plus the coupling, `S + C`.
//!
//! While no multiplier joins or leaves and `C` changes little, the factors of an earlier `S + C` stay in use: they
//! precondition GMRES on the new one, a few products with `S` instead of a factorisation.

use std::cell::Cell;

use crate::csr::Csr;
use crate::dense_lu::{self, Pivots};
use crate::equilibrate;
use crate::ghosts::Ghosts;
use crate::iterations::Gmres;
use crate::multifrontal::Scaling;
use crate::parallel;
use crate::square::Square;

/// Pivots of the equilibrated matrix below this are replaced and reported.
const PIVOT_LIMIT: f64 = 1e-14;
/// Equations below which a new factorisation costs no more than iterations with an old one.
const WORTH_KEEPING: usize = 600;
/// Iterations after which an old factorisation is given up; as many cost half of a new one.
const ITERATIONS: usize = 8;
/// Residual of the scaled equations that iteration aims at.
const AIM: f64 = 1e-13;
/// Residual of the scaled equations above which an old factorisation is given up.
const ACCEPTED: f64 = 1e-10;

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
struct InactiveEquation {
    at: u32,
    diagonal: f64,
    others: Vec<(u32, f64)>,
}

/// Partition of the equations of an interface, as the coupling decides it.
struct Parts {
    inactive: Vec<InactiveEquation>,
    /// Local index of each equation of the dense block.
    kept: Vec<u32>,
    /// Entries of the coupling in the dense block.
    entries: Vec<(usize, usize, f64)>,
}

impl Parts {
    fn new(coupling: &Csr, in_bulk: impl Fn(usize) -> bool) -> Self {
        let n = coupling.rows;
        let nonzero = |at: usize| {
            let (columns, values) = coupling.row(at);
            columns.iter().zip(values).map(|(&j, &value)| (j as usize, value)).filter(|(_, value)| *value != 0.0)
        };
        let mut inactive_of: Vec<Option<InactiveEquation>> = (0..n)
            .map(|at| {
                let mut entries = nonzero(at);
                match (entries.next(), entries.next()) {
                    (Some((j, diagonal)), None) if j == at && !in_bulk(at) => {
                        Some(InactiveEquation { at: at as u32, diagonal, others: Vec::new() })
                    }
                    _ => None,
                }
            })
            .collect();
        let kept: Vec<u32> = (0..n as u32).filter(|&at| inactive_of[at as usize].is_none()).collect();
        let mut dense_index = vec![usize::MAX; n];
        for (index, &at) in kept.iter().enumerate() {
            dense_index[at as usize] = index;
        }
        let mut entries = Vec::new();
        for at in 0..n {
            for (column, value) in nonzero(at) {
                match &mut inactive_of[column] {
                    Some(inactive) if column != at => inactive.others.push((at as u32, value)),
                    Some(_) => {}
                    None => entries.push((dense_index[at], dense_index[column], value)),
                }
            }
        }
        Self { inactive: inactive_of.into_iter().flatten().collect(), kept, entries }
    }
}

/// The factorised interface system; lone equations (inactive multipliers) are kept out of the dense block.
pub(crate) struct Interface {
    parts: Parts,
    factor: DenseFactor,
    /// The coupling of now, when the factors are those of an earlier one.
    newer: Option<Csr>,
    /// Whether iteration with the factors of an earlier coupling failed.
    lost: Cell<bool>,
}

impl Interface {
    /// Factorises `schur` plus the `coupling` of the same equations.
    ///
    /// `in_bulk` tells whether the bulk knows an equation. `earlier` belongs to the same `schur`: its factors stay in
    /// use where they may, else it gives its memory.
    pub(crate) fn new(
        schur: &Square,
        coupling: Csr,
        in_bulk: impl Fn(usize) -> bool,
        earlier: Option<Interface>,
    ) -> Self {
        let n = coupling.rows;
        let parts = Parts::new(&coupling, in_bulk);
        let mut values = Vec::new();
        if let Some(earlier) = earlier {
            if n >= WORTH_KEEPING && earlier.parts.kept == parts.kept && !earlier.is_suspicious() && !earlier.lost.get()
            {
                return Self { newer: Some(coupling), ..earlier };
            }
            values = earlier.factor.into_values();
        }
        let scaling = scaling(schur, &parts);
        let m = parts.kept.len();
        if values.len() != m * m {
            drop(std::mem::take(&mut values));
            values = vec![0.0; m * m];
        }
        dense_block(schur, &parts.kept, &scaling, &mut values);
        for &(i, j, value) in &parts.entries {
            values[i + m * j] += value * scaling.row[i] * scaling.column[j];
        }
        Self { parts, factor: DenseFactor::new(values, scaling), newer: None, lost: Cell::new(false) }
    }

    /// Replaces `x`, in the order of the interface, by the solution; `schur` is that of [`Interface::new`].
    pub(crate) fn solve(&self, schur: &Square, x: &mut [f64]) {
        let Some(coupling) = &self.newer else { return self.solve_factorised(x) };
        let n = x.len();
        let mut scale = vec![0.0; n];
        self.parts.inactive.iter().for_each(|inactive| scale[inactive.at as usize] = 1.0 / inactive.diagonal.abs());
        self.parts.kept.iter().zip(&self.factor.scaling.row).for_each(|(&at, row)| scale[at as usize] = *row);
        let rhs: Vec<f64> = x.iter().zip(&scale).map(|(x, scale)| x * scale).collect();
        let multiply = |x: &[f64], y: &mut [f64]| {
            y.fill(0.0);
            coupling.mul_vec_subtract(x, y);
            schur.mul_vec_subtract(x, y);
            y.iter_mut().zip(&scale).for_each(|(y, scale)| *y *= -scale);
        };
        let precondition = |x: &mut [f64], _: f64| {
            x.iter_mut().zip(&scale).for_each(|(x, scale)| *x /= scale);
            self.solve_factorised(x);
        };
        x.fill(0.0);
        let (ghosts, mut method) = (Ghosts::none(rhs.len()), Gmres::default());
        let progress = method.solve(None, &ghosts, multiply, precondition, &rhs, x, ITERATIONS, ITERATIONS, AIM);
        if progress.relative_residual > ACCEPTED || progress.relative_residual.is_nan() {
            self.lost.set(true);
        }
    }

    /// Leaves no more than memory to the next interface, as when the bulk changed.
    pub(crate) fn forget(&mut self) {
        self.lost.set(true);
    }

    /// Whether the factors of an earlier coupling turned out to be of no use for the one of now.
    pub(crate) fn is_lost(&self) -> bool {
        self.lost.get()
    }

    fn solve_factorised(&self, x: &mut [f64]) {
        let Parts { inactive, kept, .. } = &self.parts;
        for inactive in inactive {
            x[inactive.at as usize] /= inactive.diagonal;
        }
        for inactive in inactive {
            let value = x[inactive.at as usize];
            for &(at, entry) in &inactive.others {
                x[at as usize] -= entry * value;
            }
        }
        let mut dense: Vec<f64> = kept.iter().map(|&at| x[at as usize]).collect();
        self.factor.solve(&mut dense);
        for (&at, value) in kept.iter().zip(dense) {
            x[at as usize] = value;
        }
    }

    /// Whether the dense block is nearly singular.
    pub(crate) fn is_suspicious(&self) -> bool {
        self.factor.is_suspicious()
    }
}

/// Scale factors of the dense block of a Schur complement and a coupling.
///
/// The diagonal stands for the whole Schur complement, since no entry of a positive definite matrix exceeds the
/// geometric mean of its diagonal entries; that spares passes over the dense matrix.
fn scaling(schur: &Square, parts: &Parts) -> Scaling {
    let diagonal = parts.kept.iter().enumerate().map(|(at, &i)| (at, at, schur.diagonal(i as usize)));
    let sample: Vec<(usize, usize, f64)> = diagonal.chain(parts.entries.iter().copied()).collect();
    equilibrate::factors(&Csr::from_triplets(parts.kept.len(), &sample))
}

/// Writes the scaled rows and columns `kept` of a Schur complement to a column-major block.
fn dense_block(schur: &Square, kept: &[u32], scaling: &Scaling, values: &mut [f64]) {
    let m = kept.len().max(1);
    parallel::groups_mut(values, m, 16, |k, target| {
        let column = kept[k] as usize;
        let first = if schur.is_symmetric() { k } else { 0 };
        let from = kept[first] as usize;
        let source = schur.below(column, from);
        for ((value, &row), row_scale) in target[first..].iter_mut().zip(&kept[first..]).zip(&scaling.row[first..]) {
            *value = source[row as usize - from] * row_scale * scaling.column[k];
        }
    });
    if schur.is_symmetric() {
        let ratio: Vec<f64> = scaling.row.iter().zip(&scaling.column).map(|(row, column)| row / column).collect();
        mirror_lower(values, &ratio);
    }
}

/// Makes the upper triangle of a scaled symmetric matrix from the lower one, tile by tile; `ratio` is that of the scale factors
/// of rows to those of columns, all powers of two.
fn mirror_lower(values: &mut [f64], ratio: &[f64]) {
    const TILE: usize = 64;
    let order = ratio.len();
    for block in (0..order).step_by(TILE) {
        let block_end = (block + TILE).min(order);
        let (left, right) = values.split_at_mut(block_end * order);
        for j in block..block_end {
            for i in block..j {
                left[i + j * order] = left[j + i * order] * (ratio[i] / ratio[j]);
            }
        }
        let source = &left[block * order..];
        parallel::groups_mut(right, order, 64, |k, column| {
            let j = block_end + k;
            for i in block..block_end {
                column[i] = source[j + (i - block) * order] * (ratio[i] / ratio[j]);
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lone_equations_are_solved_apart() {
        let schur = Square::over(vec![4.0, 1.0, 0.0, 1.0, 3.0, 0.0, 0.0, 0.0, 0.0], 3, false);
        let coupling = Csr::from_triplets(3, &[(0, 2, 5.0), (2, 2, -2.0)]);
        let interface = Interface::new(&schur, coupling, |at| at < 2, None);
        assert_eq!((interface.parts.inactive.len(), interface.parts.kept.len()), (1, 2));
        let mut x = [4.0 + 2.0 - 15.0, 1.0 + 6.0, 6.0];
        interface.solve(&schur, &mut x);
        for (x, exact) in x.iter().zip([1.0, 2.0, -3.0]) {
            assert!((x - exact).abs() < 1e-14);
        }
    }

    /// A dense Schur complement `2 I + 1 1ᵀ / n`, whose last `multipliers` equations are unknown to it.
    fn schur(n: usize, multipliers: usize) -> Square {
        let mut schur = Square::over(vec![0.0; Square::size(n, true)], n, true);
        for j in 0..n - multipliers {
            (j..n - multipliers).for_each(|i| *schur.entry_mut(i, j) = 1.0 / n as f64);
            *schur.entry_mut(j, j) += 2.0;
        }
        schur
    }

    /// Multipliers at the end, each of which ties one equation, and one that is inactive.
    fn ties(n: usize, multipliers: usize, strength: f64) -> Csr {
        let first = n - multipliers;
        let mut triplets = vec![(n - 1, n - 1, -1e-3), (3, n - 1, 0.5)];
        for k in 0..multipliers - 1 {
            triplets.extend([
                (first + k, 2 * k, strength),
                (2 * k, first + k, 1.0),
                (2 * k, 2 * k + 1, 1.0 - strength),
            ]);
        }
        Csr::from_triplets(n, &triplets)
    }

    fn error(interface: &Interface, schur: &Square, coupling: &Csr) -> f64 {
        let n = coupling.rows;
        let exact: Vec<f64> = (0..n).map(|i| (i % 7) as f64 - 3.0).collect();
        let mut x = vec![0.0; n];
        coupling.mul_vec_subtract(&exact, &mut x);
        schur.mul_vec_subtract(&exact, &mut x);
        x.iter_mut().for_each(|x| *x = -*x);
        interface.solve(schur, &mut x);
        x.iter().zip(&exact).map(|(x, exact)| (x - exact).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn a_small_change_of_the_coupling_keeps_the_factors_and_a_large_one_loses_them() {
        let (n, multipliers) = (WORTH_KEEPING + 50, 50);
        let schur = schur(n, multipliers);
        let in_bulk = |at: usize| at < n - multipliers;
        let mut interface = Interface::new(&schur, ties(n, multipliers, 1.0), in_bulk, None);
        assert!(interface.newer.is_none() && error(&interface, &schur, &ties(n, multipliers, 1.0)) < 1e-11);
        let near = ties(n, multipliers, 1.01);
        interface = Interface::new(&schur, near.clone(), in_bulk, Some(interface));
        assert!(interface.newer.is_some());
        assert!(error(&interface, &schur, &near) < 1e-11 && !interface.is_lost());
        let mut far = ties(n, multipliers, 1.0);
        far.values.iter_mut().enumerate().for_each(|(i, value)| *value *= 1.0 + (i % 13) as f64);
        interface = Interface::new(&schur, far.clone(), in_bulk, Some(interface));
        error(&interface, &schur, &far);
        assert!(interface.is_lost());
        interface = Interface::new(&schur, far.clone(), in_bulk, Some(interface));
        assert!(interface.newer.is_none() && error(&interface, &schur, &far) < 1e-11);
    }

    #[test]
    fn a_multiplier_that_becomes_active_asks_for_new_factors() {
        let (n, multipliers) = (WORTH_KEEPING + 50, 50);
        let schur = schur(n, multipliers);
        let in_bulk = |at: usize| at < n - multipliers;
        let before = Interface::new(&schur, ties(n, multipliers, 1.0), in_bulk, None);
        let active = ties(n, multipliers, 1.0).plus(&Csr::from_triplets(n, &[(n - 1, 200, 1.0)]));
        let after = Interface::new(&schur, active.clone(), in_bulk, Some(before));
        assert!(after.newer.is_none() && error(&after, &schur, &active) < 1e-11);
    }
}
