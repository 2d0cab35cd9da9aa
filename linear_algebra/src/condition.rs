//! Extreme eigenvalues of a system, for its condition number.

use crate::check;
use crate::direct::DirectSolver;
use crate::solver::{DirectSettings, LinearSolver, SolveError};
use crate::system::System;
use crate::vector;

/// Steps of each iteration at most.
const STEPS: usize = 500;
/// Relative change of the estimate at which an iteration stops.
const ACCURACY: f64 = 1e-5;

/// Sizes of the extreme eigenvalues of a matrix, both positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spectrum {
    /// Largest absolute value of an eigenvalue.
    pub largest: f64,
    /// Smallest absolute value of an eigenvalue.
    pub smallest: f64,
}

impl Spectrum {
    /// Condition number of a symmetric matrix, an estimate otherwise.
    pub fn condition_number(&self) -> f64 {
        self.largest / self.smallest
    }
}

/// Estimates the extreme eigenvalues of `bulk + coupling` by power and inverse power iteration, to a few digits.
///
/// # Errors
/// Errors of the direct engine, [`SolveError::Singular`] among them.
pub fn condition_number(system: &System<'_>) -> Result<Spectrum, SolveError> {
    let start = check::pseudo_random(system.equations());
    let largest = growth(start.clone(), |x, y| {
        system.mul_vec(x, y);
        Ok(())
    })?;
    let mut solver = DirectSolver::new(DirectSettings::default());
    let inverse = growth(start, |x, y| solver.solve(system, x, y).map(|_| ()))?;
    Ok(Spectrum { largest, smallest: 1.0 / inverse })
}

/// Factor by which a map lengthens its dominant vector.
///
/// Taken over two steps, since eigenvalues of equal size and opposite sign would make single steps oscillate.
fn growth(
    mut x: Vec<f64>,
    mut map: impl FnMut(&[f64], &mut [f64]) -> Result<(), SolveError>,
) -> Result<f64, SolveError> {
    let mut y = vec![0.0; x.len()];
    let mut estimate = 0.0;
    for _ in 0..STEPS {
        let mut factor = 1.0;
        for _ in 0..2 {
            let length = vector::norm(&x);
            x.iter_mut().for_each(|x| *x /= length);
            map(&x, &mut y)?;
            factor *= vector::norm(&y);
            std::mem::swap(&mut x, &mut y);
        }
        let next = factor.sqrt();
        if next == 0.0 || (next - estimate).abs() <= ACCURACY * next {
            return Ok(next);
        }
        estimate = next;
    }
    Ok(estimate)
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
        assert!((found.largest / exact(n) - 1.0).abs() < 1e-3, "{found:?}");
        assert!((found.smallest / exact(1) - 1.0).abs() < 1e-4, "{found:?}");
    }
}
