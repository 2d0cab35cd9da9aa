//! Solutions of earlier solves as the start of the next one.
//!
//! Loads that grow over steps and a tangent that changes little make solutions that are nearly combinations of those before. The start is
//! the combination `x = Σ y_i x_i` that leaves the least `‖b - A x‖` (Fischer, Comput. Methods Appl. Mech. Engrg. 163 (1998)), with the
//! matrix of the present solve: a changed matrix costs digits of the start, never of the solution.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use crate::ghosts::Ghosts;
use crate::vector::{add_scaled, copied, scale_by, scale_to, set_length, zeros};

/// Solutions kept.
const KEPT: usize = 6;
/// Share of a product that must be left beside those of later solutions for it to count.
const INDEPENDENT: f64 = 1e-7;

/// A solution of an earlier solve.
#[derive(Clone, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct PreviousSolution {
    /// Solution scaled to a length between one and two: division by a power of two changes no digit of it or of its product.
    pub x: Vec<f64>,
    /// Its product with the bulk of a system, with the stamp of the values of that bulk.
    #[serde(skip)]
    product: Option<(u64, Vec<f64>)>,
}

impl PreviousSolution {
    /// The product with the bulk of this stamp: `multiply(x, y)` makes it where it is not known.
    pub(crate) fn product(&mut self, stamp: u64, multiply: impl FnOnce(&[f64], &mut [f64])) -> &[f64] {
        let known = self.product.take().filter(|(of, _)| *of == stamp);
        let (_, product) = self.product.insert(known.unwrap_or_else(|| {
            let mut product = zeros(self.x.len());
            multiply(&self.x, &mut product);
            (stamp, product)
        }));
        product
    }
}

/// The latest solutions of a solver.
#[derive(Clone, Default, Serialize, Deserialize)]
pub(crate) struct PreviousSolutions {
    /// Graph of the matrix that they are solutions of.
    graph: u64,
    latest: VecDeque<PreviousSolution>,
}

impl PreviousSolutions {
    /// Keeps a solution for systems with this graph, with its product with the bulk of a stamp where that is known.
    pub(crate) fn keep(&mut self, graph: u64, ghosts: &Ghosts, x: &[f64], product: Option<(u64, &[f64])>) {
        if self.graph != graph {
            self.latest.clear();
            self.graph = graph;
        }
        let size = ghosts.norm(x);
        if size >= f64::MIN_POSITIVE && size.is_finite() {
            let factor = (-size.log2().floor()).exp2();
            let mut kept = if self.latest.len() < KEPT { None } else { self.latest.pop_back() }.unwrap_or_default();
            let scaled = |from: &[f64], mut to: Vec<f64>| {
                set_length(&mut to, from.len());
                scale_to(factor, from, &mut to);
                to
            };
            let old = kept.product.take().map(|(_, product)| product).unwrap_or_default();
            kept.product = product.map(|(stamp, product)| (stamp, scaled(product, old)));
            kept.x = scaled(x, kept.x);
            self.latest.push_front(kept);
        }
    }

    /// Sets `x` to the combination of previous solutions with the least residual of `b`, or one of no more than `enough` times its
    /// norm, and returns the residual's norm; `multiply(answer, y)` is `y = A x`.
    pub(crate) fn start(
        &mut self,
        graph: u64,
        ghosts: &Ghosts,
        mut multiply: impl FnMut(&mut PreviousSolution, &mut [f64]),
        b: &[f64],
        enough: f64,
        x: &mut [f64],
    ) -> Vec<f64> {
        if self.graph != graph || self.latest.iter().any(|kept| kept.x.len() != x.len()) {
            return copied(b);
        }
        // Orthonormal products; their solutions, with the coefficients of those before and the part of b along it.
        let mut basis: Vec<Vec<f64>> = Vec::new();
        let mut found: Vec<(&[f64], Vec<f64>, f64)> = Vec::new();
        let mut rest = copied(b);
        let least = enough * ghosts.norm(b);
        for kept in &mut self.latest {
            if ghosts.norm(&rest) <= least {
                break;
            }
            let mut product = zeros(b.len());
            multiply(kept, &mut product);
            let before = ghosts.norm(&product);
            let mut column = ghosts.orthogonalise(&basis, &mut product);
            let left = ghosts.norm(&product);
            if left > INDEPENDENT * before && left.is_finite() {
                scale_by(1.0 / left, &mut product);
                column.push(left);
                let along = ghosts.dot(&product, &rest);
                add_scaled(-along, &product, &mut rest);
                basis.push(product);
                found.push((&kept.x, column, along));
            }
        }
        let mut factors: Vec<f64> = found.iter().map(|(_, _, along)| *along).collect();
        for (k, (kept, column, _)) in found.iter().enumerate().rev() {
            factors[k] /= column[k];
            (0..k).for_each(|i| factors[i] -= factors[k] * column[i]);
            add_scaled(factors[k], kept, x);
        }
        rest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_combination_of_answers_is_found_and_no_more() {
        let diagonal = [1.0, 2.0, 4.0, 8.0];
        let multiply = |answer: &mut PreviousSolution, y: &mut [f64]| {
            let product =
                |x: &[f64], y: &mut [f64]| y.iter_mut().zip(x).zip(diagonal).for_each(|((y, x), d)| *y = d * x);
            y.copy_from_slice(answer.product(1, product));
        };
        let mut previous = PreviousSolutions::default();
        previous.keep(7, &Ghosts::none(4), &[1.0, 1.0, 0.0, 0.0], None);
        // Its product is known, by a wrong stamp and by the right one.
        previous.keep(7, &Ghosts::none(4), &[0.0, 1.0, 1.0, 0.0], Some((3, &[0.0; 4])));
        previous.keep(7, &Ghosts::none(4), &[2.0, 2.0, 0.0, 0.0], Some((1, &[2.0, 4.0, 0.0, 0.0])));
        let mut x = [0.0; 4];
        let left = previous.start(7, &Ghosts::none(4), multiply, &[3.0, 2.0, -8.0, 0.8], 0.0, &mut x);
        // 3 (1, 1, 0, 0) and the best multiple of (0, 1, 1, 0) for (0, -4, -8, 0.8).
        let expected = [3.0, 1.0, -2.0, 0.0];
        assert!(x.iter().zip(expected).all(|(x, e)| (x - e).abs() < 1e-12), "{x:?}");
        let rest = [0.0, 0.0, 0.0, 0.8];
        assert!(left.iter().zip(rest).all(|(left, rest)| (left - rest).abs() < 1e-12), "{left:?}");
        // A known product is not computed again, unless the matrix is another.
        let known = |answer: &mut PreviousSolution, y: &mut [f64]| {
            y.copy_from_slice(answer.product(1, |_, _| unreachable!("the product is known")));
        };
        let mut again = [0.0; 4];
        previous.start(7, &Ghosts::none(4), known, &[3.0, 2.0, -8.0, 0.8], 0.0, &mut again);
        assert_eq!(again, x);
        let mut twice = [0.0; 4];
        let of_another = |answer: &mut PreviousSolution, y: &mut [f64]| {
            let double =
                |x: &[f64], y: &mut [f64]| y.iter_mut().zip(x).zip(diagonal).for_each(|((y, x), d)| *y = 2.0 * d * x);
            y.copy_from_slice(answer.product(2, double));
        };
        previous.start(7, &Ghosts::none(4), of_another, &[3.0, 2.0, -8.0, 0.8], 0.0, &mut twice);
        assert!(twice.iter().zip(x).all(|(half, x)| (2.0 * half - x).abs() < 1e-12), "{twice:?}");
        let mut other = [0.0; 4];
        previous.start(8, &Ghosts::none(4), multiply, &[3.0, 2.0, -8.0, 0.8], 0.0, &mut other);
        assert_eq!(other, [0.0; 4], "answers of another system");
    }
}
