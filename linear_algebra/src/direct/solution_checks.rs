//! Solutions improved by iteration, and their diagnosis of a matrix: whether it is singular, and where.

use super::WANTED;
use super::factorized_system::FactorizedSystem;
use crate::check::{self, NAMED_EQUATIONS, Refined};
use crate::ghosts::Ghosts;
use crate::iterations::Gmres;
use crate::system::System;
use crate::vector;

/// Krylov iterations before a factorisation is given up.
const KRYLOV_ITERATIONS: usize = 40;

/// Continues from the better of `x` and zero by GMRES, preconditioned with the factors.
pub(super) fn krylov(
    system: &System<'_>,
    path: &FactorizedSystem,
    rhs: &[f64],
    x: &mut [f64],
    before: Refined,
) -> Refined {
    let mut trial = if before.relative_residual < 1.0 { x.to_vec() } else { vec![0.0; x.len()] };
    let progress = Gmres::default().solve(
        None,
        &Ghosts::none(rhs.len()),
        |x, y| system.mul_vec(x, y),
        |r, _| path.apply(r),
        rhs,
        &mut trial,
        KRYLOV_ITERATIONS,
        KRYLOV_ITERATIONS,
        WANTED,
    );
    let steps = before.steps + progress.iterations;
    if before.relative_residual <= progress.relative_residual {
        return Refined { steps, ..before };
    }
    x.copy_from_slice(&trial);
    Refined { relative_residual: progress.relative_residual, steps }
}

/// Whether a right-hand side that no singular matrix could produce is solved.
pub(super) fn is_regular(system: &System<'_>, path: &FactorizedSystem) -> bool {
    let mut x = check::pseudo_random(system.equations());
    system.clear_inactive(&mut x);
    let mut rhs = check::magnitude(system, &vec![1.0; x.len()]);
    rhs.iter_mut().zip(&x).for_each(|(size, x)| *size *= x);
    let mut solution = vec![0.0; x.len()];
    let mut refined = check::refine(system, &rhs, &mut solution, 2, check::GOOD_ENOUGH, |r| path.apply(r));
    if !refined.reaches(1e-8) {
        refined = krylov(system, path, &rhs, &mut solution, refined);
    }
    refined.reaches(1e-8)
}

/// A vector the matrix nearly maps to zero, by inverse iteration, and how nearly: `‖A v‖ / ‖|A| 1‖`, `v` of size one.
pub(super) fn null_vector(system: &System<'_>, path: &FactorizedSystem) -> (Vec<f64>, f64) {
    let mut vector = check::pseudo_random(system.equations());
    system.clear_inactive(&mut vector);
    for _ in 0..4 {
        path.apply(&mut vector);
        let size = vector.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        if size == 0.0 || !size.is_finite() {
            return (vector, f64::NAN);
        }
        vector.iter_mut().for_each(|v| *v /= size);
    }
    let mut image = vec![0.0; vector.len()];
    system.mul_vec(&vector, &mut image);
    let ratio = vector::norm(&image) / vector::norm(&check::magnitude(system, &vec![1.0; vector.len()]));
    (vector, ratio)
}

/// Equations with the largest entries of a vector, largest first.
pub(super) fn largest_entries(vector: &[f64]) -> Vec<usize> {
    let largest = vector.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let mut order: Vec<usize> = (0..vector.len()).filter(|&i| vector[i].abs() >= 0.1 * largest).collect();
    order.sort_by(|&a, &b| vector[b].abs().total_cmp(&vector[a].abs()).then(a.cmp(&b)));
    order.truncate(NAMED_EQUATIONS);
    order
}
