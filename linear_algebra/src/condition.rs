//! Extreme eigenvalues of a system, for its condition number κ = |λ_max|/|λ_min| (eqs. 4.18b, D.23).

use nalgebra::{DMatrix, SymmetricEigen};

use crate::check;
use crate::direct::DirectSolver;
use crate::solver::{DirectSettings, LinearSolver, SolveError};
use crate::system::System;
use crate::vector;

/// Steps of Lanczos' method at most.
const STEPS: usize = 300;
/// Steps between two looks at the eigenvalues.
const LOOK: usize = 5;
/// Residual of an eigenvalue, as a share of it, at which the method stops.
const ACCURACY: f64 = 1e-5;

/// Sizes of the extreme eigenvalues of a matrix, both positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spectrum {
    /// Largest absolute value of an eigenvalue.
    pub largest: f64,
    /// Smallest absolute value of an eigenvalue.
    pub smallest: f64,
    /// Whether both have converged.
    pub converged: bool,
}

impl Spectrum {
    /// Condition number of a symmetric matrix, an estimate otherwise.
    pub fn condition_number(&self) -> f64 {
        self.largest / self.smallest
    }
}

/// The extreme eigenvalues of `bulk + coupling` by Lanczos' method for the matrix and its inverse.
///
/// Rows of multipliers enter with the sign that makes the matrix symmetric: systems of contact state −k Nᵀ λ beside +k N u.
///
/// # Errors
/// Errors of the direct engine, [`SolveError::Singular`] among them.
pub fn condition_number(system: &System<'_>) -> Result<Spectrum, SolveError> {
    let start = check::pseudo_random(system.equations());
    let turned = is_symmetric_turned(system, &start);
    let turn = |x: &mut [f64]| {
        let rows = x.iter_mut().zip(&system.layout.multiplier);
        rows.filter(|(_, multiplier)| turned && **multiplier).for_each(|(x, _)| *x = -*x);
    };
    let (largest, first) = largest(start.clone(), |x, y| {
        system.mul_vec(x, y);
        turn(y);
        Ok(())
    })?;
    let mut solver = DirectSolver::new(DirectSettings::default());
    let mut rhs = vec![0.0; start.len()];
    let (inverse, last) = self::largest(start, |x, y| {
        rhs.copy_from_slice(x);
        turn(&mut rhs);
        solver.solve(system, &rhs, y).map(|_| ())
    })?;
    Ok(Spectrum { largest, smallest: 1.0 / inverse, converged: first && last })
}

/// Whether the matrix is nearer to a symmetric one once the rows of multipliers have the other sign: by u·Av − v·Au.
fn is_symmetric_turned(system: &System<'_>, u: &[f64]) -> bool {
    let v: Vec<f64> = u.iter().rev().map(|x| x * x - 0.5).collect();
    let mut images = [vec![0.0; u.len()], vec![0.0; u.len()]];
    let [of_u, of_v] = &mut images;
    system.mul_vec(u, of_u);
    system.mul_vec(&v, of_v);
    let mut lacks = [0.0; 2];
    for (at, &multiplier) in system.layout.multiplier.iter().enumerate() {
        let lack = u[at] * of_v[at] - v[at] * of_u[at];
        lacks[0] += lack;
        lacks[1] += if multiplier { -lack } else { lack };
    }
    lacks[1].abs() < lacks[0].abs()
}

/// Largest size of an eigenvalue of a symmetric map, by Lanczos' method with full orthogonalisation, and whether it has converged.
fn largest(
    start: Vec<f64>,
    mut map: impl FnMut(&[f64], &mut [f64]) -> Result<(), SolveError>,
) -> Result<(f64, bool), SolveError> {
    let size = start.len();
    let length = vector::norm(&start);
    let mut basis = vec![start.into_iter().map(|x| x / length).collect::<Vec<f64>>()];
    let (mut diagonal, mut beside) = (Vec::new(), Vec::new());
    let mut image = vec![0.0; size];
    loop {
        let last = &basis[basis.len() - 1];
        map(last, &mut image)?;
        diagonal.push(vector::dot(&image, last));
        // Twice is enough.
        for own in basis.iter().chain(&basis) {
            let along = vector::dot(&image, own);
            image.iter_mut().zip(own).for_each(|(x, own)| *x -= along * own);
        }
        let rest = vector::norm(&image);
        let (steps, is_last) = (diagonal.len(), diagonal.len() == STEPS.min(size));
        if is_last || steps.is_multiple_of(LOOK) {
            let (value, end) = extreme(&diagonal, &beside);
            let converged = rest * end <= ACCURACY * value || steps == size;
            if converged || is_last {
                return Ok((value, converged));
            }
        }
        beside.push(rest);
        basis.push(image.iter().map(|x| x / rest).collect());
    }
}

/// Eigenvalue of largest size of a symmetric tridiagonal matrix, and the last entry of its vector, both without sign.
fn extreme(diagonal: &[f64], beside: &[f64]) -> (f64, f64) {
    let size = diagonal.len();
    let matrix = DMatrix::from_fn(size, size, |row, column| match row.abs_diff(column) {
        0 => diagonal[row],
        1 => beside[row.min(column)],
        _ => 0.0,
    });
    let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(matrix);
    let at = eigenvalues.iamax();
    (eigenvalues[at].abs(), eigenvectors[(size - 1, at)].abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::csr::Csr;
    use crate::system::{Layout, Symmetry};

    #[test]
    fn eigenvalues_of_a_chain() {
        let n = 20;
        let mut triplets: Vec<(usize, usize, f64)> = (0..n).map(|i| (i, i, 2.0)).collect();
        for i in 1..n {
            triplets.extend([(i, i - 1, -1.0), (i - 1, i, -1.0)]);
        }
        let (matrix, layout) = (Csr::from_triplets(n, &triplets), Layout::scalar(n));
        let found = condition_number(&System::bulk(&layout, &matrix, Symmetry::PositiveDefinite)).unwrap();
        let exact = |k: usize| 2.0 - 2.0 * (k as f64 * std::f64::consts::PI / (n + 1) as f64).cos();
        assert!((found.largest / exact(n) - 1.0).abs() < 1e-9, "{found:?}");
        assert!((found.smallest / exact(1) - 1.0).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn rows_of_multipliers_with_the_other_sign_change_nothing() {
        // Two springs 3 and 1 and the multiplier of the first: eigenvalues of [3 0 2; 0 1 0; 2 0 0] are 4, 1 and −1.
        for sign in [1.0, -1.0] {
            let triplets = [(0, 0, 3.0), (1, 1, 1.0), (0, 2, sign * 2.0), (2, 0, 2.0)];
            let layout = Layout { node: vec![0, 1, 0], multiplier: vec![false, false, true], ..Layout::default() };
            let matrix = Csr::from_triplets(3, &triplets);
            let found = condition_number(&System::bulk(&layout, &matrix, Symmetry::General)).unwrap();
            assert!((found.largest - 4.0).abs() < 1e-9 && (found.smallest - 1.0).abs() < 1e-9, "{sign}: {found:?}");
        }
    }
}
