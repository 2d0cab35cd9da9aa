//! Linear complementarity problems: w = q + M z with w ≥ 0, z ≥ 0 and w z = 0 in each condition.
//!
//! Principal pivots exchange w and z of conditions in the dense table of M, O(n²) each; [`BlockPivoting`] chooses them. With a
//! P-matrix every pivot is positive and the solution is unique.

use crate::block_pivoting::{BlockPivoting, Exchange};

/// Share of the pivot that a condition begins with, below which a pivot is zero but for round-off.
const SINGULAR: f64 = 1e-9;

/// Pivots a condition after which the problem counts as one that has no solution.
const MOST_PIVOTS: usize = 20;

/// A linear complementarity problem; its exchanges are made in place.
#[derive(Debug, Clone, PartialEq)]
pub struct Complementarity {
    /// Values of the basic quantities, w where a condition is not exchanged; those below zero violate their condition.
    values: Vec<f64>,
    /// Change of the basic quantities (rows) with the others (columns), row by row.
    table: Vec<f64>,
    /// Sizes up to which w and z of a condition are zero.
    small: Vec<[f64; 2]>,
    /// Which conditions have exchanged w and z.
    exchanged: Vec<bool>,
    /// The diagonal of M.
    first_pivots: Vec<f64>,
}

impl Complementarity {
    /// The problem of `q` and `M`, row by row; `small` are the sizes up to which w and z of each condition count as zero.
    ///
    /// # Panics
    /// Sizes that do not fit.
    pub fn new(q: Vec<f64>, m: Vec<f64>, small: Vec<[f64; 2]>) -> Self {
        let n = q.len();
        assert!(m.len() == n * n && small.len() == n, "a square matrix and two sizes a condition");
        let first_pivots = (0..n).map(|at| m[at * n + at]).collect();
        Self { values: q, table: m, small, exchanged: vec![false; n], first_pivots }
    }

    /// Solves the problem; of each condition whether z is positive or w is, and the value of that one. `None` where a pivot is not
    /// positive beyond round-off, so that M is no P-matrix, or where pivots do not end.
    pub fn solve(mut self) -> Option<Vec<(bool, f64)>> {
        let mut rule = BlockPivoting::default();
        let mut left = MOST_PIVOTS * self.values.len();
        loop {
            let violated: Vec<usize> = (0..self.values.len()).filter(|&at| self.is_violated(at)).collect();
            let Some(&last) = violated.last() else {
                return Some(self.exchanged.into_iter().zip(self.values).collect());
            };
            let exchange = if rule.next(violated.len()) == Exchange::All { violated } else { vec![last] };
            left = left.checked_sub(exchange.len())?;
            for at in exchange {
                self.pivot(at)?;
            }
        }
    }

    fn is_violated(&self, at: usize) -> bool {
        self.values[at] < -self.small[at][usize::from(self.exchanged[at])]
    }

    /// Exchanges w and z of a condition; `None` where their pivot is not positive beyond round-off.
    fn pivot(&mut self, at: usize) -> Option<()> {
        let n = self.values.len();
        let pivot = self.table[at * n + at];
        let first = self.first_pivots[at];
        let least = SINGULAR * if self.exchanged[at] { first.recip() } else { first };
        if pivot.is_nan() || pivot <= least.max(0.0) {
            return None;
        }
        let mut row: Vec<f64> = self.table[at * n..(at + 1) * n].iter().map(|entry| -entry / pivot).collect();
        row[at] = pivot.recip();
        let value = -self.values[at] / pivot;
        for other in (0..n).filter(|&other| other != at) {
            let own = &mut self.table[other * n..(other + 1) * n];
            let factor = std::mem::take(&mut own[at]);
            self.values[other] += factor * value;
            own.iter_mut().zip(&row).for_each(|(entry, along)| *entry += factor * along);
        }
        self.table[at * n..(at + 1) * n].copy_from_slice(&row);
        self.values[at] = value;
        self.exchanged[at] ^= true;
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Solves with exact zeros; gives w and z.
    fn solve(q: &[f64], m: &[f64]) -> Option<[Vec<f64>; 2]> {
        let solved = Complementarity::new(q.to_vec(), m.to_vec(), vec![[0.0; 2]; q.len()]).solve()?;
        let part = |wanted: bool| solved.iter().map(|&(z, v)| if z == wanted { v } else { 0.0 }).collect();
        Some([part(false), part(true)])
    }

    /// Numbers of (0, 1) that are always the same.
    fn random(count: usize) -> Vec<f64> {
        let mut state = 7_u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..count).map(|_| next()).collect()
    }

    #[test]
    fn exchanges_of_all_that_run_in_circles_end() {
        // Full exchanges alone come back to the empty set after three rounds.
        let (q, m) = ([-1.0, -3.0, 2.0], [1.0, 1.0, -2.0, 0.0, 1.0, -2.0, 2.0, 0.0, 1.0]);
        let [w, z] = solve(&q, &m).expect("a P-matrix");
        for i in 0..3 {
            let sum: f64 = q[i] + (0..3).map(|j| m[3 * i + j] * z[j]).sum::<f64>();
            assert!((sum - w[i]).abs() < 1e-12 && w[i] >= 0.0 && z[i] >= 0.0 && w[i] * z[i] == 0.0, "{w:?} {z:?}");
        }
    }

    #[test]
    fn conditions_hold_for_a_positive_definite_matrix() {
        let n = 40;
        let factor = random(n * n);
        let product = |i: usize, j: usize| (0..n).map(|k| (factor[i * n + k] - 0.5) * (factor[j * n + k] - 0.5)).sum();
        let m: Vec<f64> = (0..n * n).map(|at| product(at / n, at % n)).collect();
        let q: Vec<f64> = random(2 * n)[n..].iter().map(|x| x - 0.5).collect();
        let [w, z] = solve(&q, &m).expect("a P-matrix");
        for i in 0..n {
            let sum: f64 = q[i] + (0..n).map(|j| m[i * n + j] * z[j]).sum::<f64>();
            assert!((sum - w[i]).abs() < 1e-9 && w[i] >= 0.0 && z[i] >= 0.0, "condition {i}");
        }
        assert!(z.iter().any(|z| *z > 0.0) && w.iter().any(|w| *w > 0.0), "both sides occur");
    }

    #[test]
    fn a_matrix_without_positive_pivots_has_no_solution_here() {
        assert_eq!(solve(&[-1.0, -1.0], &[0.0, 1.0, 1.0, 0.0]), None);
    }

    #[test]
    fn a_pivot_that_is_round_off_of_the_first_one_has_no_solution_here() {
        // Once the first condition is exchanged, the second has the pivot 1e-15: two supports of one motion, the last of which goes.
        assert_eq!(solve(&[-1.0, -1.0], &[1.0, 1.0, 1.0, 1.0 + 1e-15]), None);
        assert!(solve(&[-1.0, -3.0], &[1.0, 1.0, 1.0, 1.5]).is_some());
    }

    #[test]
    fn sizes_below_the_resolution_violate_nothing() {
        let problem = Complementarity::new(vec![-1e-12], vec![1.0], vec![[1e-9, 0.0]]);
        assert_eq!(problem.solve(), Some(vec![(false, -1e-12)]));
    }
}
