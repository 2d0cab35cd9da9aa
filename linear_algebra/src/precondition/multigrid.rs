//! Smoothed-aggregation multigrid: one V-cycle with Chebyshev smoothing, symmetric for a symmetric matrix.
//!
//! Vaněk, Mandel and Brezina, Computing 56 (1996). The prolongation is `P = (I - ω D⁻¹ A) T` with the tentative `T`
//! of [`super::aggregation`], `D` the diagonal and `ω = 4 / (3 ρ(D⁻¹ A))`.

use std::sync::Arc;

use super::Precondition;
use super::aggregation::{Coarse, coarsen};
use super::rectangular::{Rectangular, product};
use crate::check;
use crate::csr::Csr;
use crate::multifrontal::{Factor, Kind, Scatter};
use crate::symbolic::Symbolic;
use crate::system::Layout;
use crate::vector;

/// Equations below which a level is solved directly.
const COARSEST: usize = 1000;
/// Largest number of levels.
const LEVELS: usize = 12;
/// Steps of the power iteration for the spectral radius.
const POWER_STEPS: usize = 12;
/// What the power iteration may have missed.
const SAFETY: f64 = 1.1;
/// Polynomial degree of the smoother.
const DEGREE: usize = 2;
/// Share of the spectrum that the smoother damps, counted from above.
const DAMPED_FROM: f64 = 0.1;

struct Level {
    matrix: Csr,
    inverse_diagonal: Vec<f64>,
    /// Upper bound of the spectrum of `D⁻¹ A`.
    radius: f64,
    prolongation: Rectangular,
    restriction: Rectangular,
}

/// The hierarchy.
pub(crate) struct Multigrid {
    levels: Vec<Level>,
    /// Factorised matrix of the last level; `None` when it has no equations.
    coarsest: Option<Factor>,
}

impl Multigrid {
    /// Builds the hierarchy on `matrix`.
    pub(crate) fn new(matrix: &Csr, layout: &Layout) -> Self {
        let mut near_null_space = layout.near_null_space.clone();
        if near_null_space.is_empty() {
            near_null_space = translations(&layout.node);
        }
        let mut group = layout.node.clone();
        let mut matrix = matrix.clone();
        let mut levels = Vec::new();
        while matrix.rows > COARSEST && levels.len() < LEVELS {
            let Some(coarse) = coarsen(&matrix, &group, &near_null_space) else { break };
            if coarse.group.len() * 4 > matrix.rows * 3 {
                break;
            }
            let (level, next) = Level::new(matrix, &coarse);
            levels.push(level);
            matrix = next;
            (group, near_null_space) = (coarse.group, coarse.near_null_space);
        }
        Self { levels, coarsest: factorise(&matrix, group) }
    }

    fn cycle(&self, depth: usize, b: &[f64], x: &mut [f64]) {
        let Some(level) = self.levels.get(depth) else {
            x.copy_from_slice(b);
            if let Some(factor) = &self.coarsest {
                factor.solve(x, |_| {});
            }
            return;
        };
        x.fill(0.0);
        let mut residual = vec![0.0; b.len()];
        level.smooth(b, x, &mut residual, true);
        residual.copy_from_slice(b);
        level.matrix.mul_vec_subtract(x, &mut residual);
        let mut coarse_b = vec![0.0; level.prolongation.columns];
        level.restriction.mul_vec_add(&residual, &mut coarse_b);
        let mut coarse_x = vec![0.0; coarse_b.len()];
        self.cycle(depth + 1, &coarse_b, &mut coarse_x);
        level.prolongation.mul_vec_add(&coarse_x, x);
        level.smooth(b, x, &mut residual, false);
    }
}

impl Precondition for Multigrid {
    fn apply(&self, x: &mut [f64]) {
        let b = x.to_vec();
        self.cycle(0, &b, x);
    }
}

/// One vector for each equation of a node: all nodes move alike.
fn translations(node: &[u32]) -> Vec<Vec<f64>> {
    let mut seen = vec![0_usize; node.iter().max().map_or(0, |&g| g as usize + 1)];
    let mut vectors: Vec<Vec<f64>> = Vec::new();
    for (i, &g) in node.iter().enumerate() {
        let component = seen[g as usize];
        seen[g as usize] += 1;
        if component == vectors.len() {
            vectors.push(vec![0.0; node.len()]);
        }
        vectors[component][i] = 1.0;
    }
    vectors
}

/// LU of the coarsest matrix; pivots of a singular one are replaced.
fn factorise(matrix: &Csr, group: Vec<u32>) -> Option<Factor> {
    let n = matrix.rows;
    let layout = Layout { node: group, multiplier: vec![false; n], near_null_space: Vec::new() };
    let symbolic = Arc::new(Symbolic::new(matrix, &layout, &vec![false; n]).ok()?);
    let scatter = Scatter::new(&symbolic, matrix, false);
    let scaling = crate::equilibrate::factors(matrix);
    Factor::new(&symbolic, &scatter, matrix, Kind::Lu { limit: 1e-9 }, Some(scaling), None).ok()
}

impl Level {
    /// A level and the matrix of the next one.
    fn new(matrix: Csr, coarse: &Coarse) -> (Self, Csr) {
        let inverse_diagonal: Vec<f64> =
            matrix.diagonal().into_iter().map(|d| if d == 0.0 { 1.0 } else { 1.0 / d }).collect();
        let radius = SAFETY * spectral_radius(&matrix, &inverse_diagonal);
        let omega = 4.0 / 3.0 * SAFETY / radius;
        let tentative = &coarse.prolongation;
        let prolongation = product(&matrix, tentative, |i, row| {
            row.iter_mut().for_each(|(_, value)| *value *= -omega * inverse_diagonal[i]);
            let range = tentative.starts[i]..tentative.starts[i + 1];
            for (&j, &value) in tentative.indices[range.clone()].iter().zip(&tentative.values[range]) {
                match row.iter_mut().find(|(column, _)| *column == j) {
                    Some((_, sum)) => *sum += value,
                    None => row.push((j, value)),
                }
            }
        });
        let restriction = prolongation.transpose();
        let next = product(&restriction, &product(&matrix, &prolongation, |_, _| {}), |_, _| {}).into_csr();
        (Self { matrix, inverse_diagonal, radius, prolongation, restriction }, next)
    }

    /// Chebyshev iteration on the upper part of the spectrum of `D⁻¹ A`.
    fn smooth(&self, b: &[f64], x: &mut [f64], residual: &mut [f64], from_zero: bool) {
        let (low, high) = (DAMPED_FROM * self.radius, self.radius);
        let (middle, half) = (0.5 * (high + low), 0.5 * (high - low));
        let sigma = middle / half;
        let mut rho = 1.0 / sigma;
        let mut step = vec![0.0; b.len()];
        for k in 0..DEGREE {
            residual.copy_from_slice(b);
            if k > 0 || !from_zero {
                self.matrix.mul_vec_subtract(x, residual);
            }
            let (keep, gain) = if k == 0 {
                (0.0, 1.0 / middle)
            } else {
                let next = 1.0 / (2.0 * sigma - rho);
                let factors = (next * rho, 2.0 * next / half);
                rho = next;
                factors
            };
            let changes = step.iter_mut().zip(residual.iter()).zip(&self.inverse_diagonal);
            changes.for_each(|((s, r), d)| *s = keep * *s + gain * d * r);
            vector::add_scaled(1.0, &step, x);
        }
    }
}

/// Spectral radius of `D⁻¹ A` by power iteration, from below.
fn spectral_radius(matrix: &Csr, inverse_diagonal: &[f64]) -> f64 {
    let mut x = check::pseudo_random(matrix.rows);
    let mut y = vec![0.0; x.len()];
    let mut radius = 1.0;
    for _ in 0..POWER_STEPS {
        let length = vector::norm(&x);
        x.iter_mut().for_each(|x| *x /= length);
        matrix.mul_vec(&x, &mut y);
        y.iter_mut().zip(inverse_diagonal).for_each(|(y, d)| *y *= d);
        radius = vector::norm(&y);
        std::mem::swap(&mut x, &mut y);
    }
    radius
}
