//! Restarted flexible GMRES: the preconditioner acts from the right, so that the residual is the true one, and may be another one
//! in each iteration (Saad, SIAM J. Sci. Comput. 14 (1993)).

use super::Progress;
use crate::ghosts::Ghosts;
use crate::vector::{Number, add_scaled, scale_by, scale_to, subtract_combination};

/// The method, with vectors that serve solve after solve.
#[derive(Default)]
pub(crate) struct Gmres<T> {
    basis: Vec<Vec<T>>,
    directions: Vec<Vec<T>>,
    work: Vec<T>,
}

/// The vector of a list at a place, of `n` entries.
fn at<T: Number>(list: &mut Vec<Vec<T>>, place: usize, n: usize) -> &mut Vec<T> {
    if list.len() == place {
        list.push(Vec::new());
    }
    list[place].resize(n, T::default());
    &mut list[place]
}

impl<T: Number> Gmres<T> {
    /// Improves `x` until `‖b - A x‖ ≤ tolerance ‖b‖` or `most` iterations are done.
    ///
    /// `ghosts` says who has which entries; `multiply(x, y)` is `y = A x`, `precondition(x, left)` replaces `x` by an approximation of
    /// `A⁻¹ x`, and the iteration would be done if that left no more than the share `left` of `x`.
    pub(crate) fn solve(
        &mut self,
        ghosts: &Ghosts,
        mut multiply: impl FnMut(&[T], &mut [T]),
        mut precondition: impl FnMut(&mut [T], f64),
        b: &[T],
        x: &mut [T],
        restart: usize,
        most: usize,
        tolerance: f64,
    ) -> Progress {
        let n = b.len();
        let scale = ghosts.norm(b);
        if scale == 0.0 {
            x.fill(T::default());
            return Progress { iterations: 0, start: 0.0, relative_residual: 0.0 };
        }
        let restart = restart.clamp(1, most.max(1));
        let Self { basis, directions, work } = self;
        work.resize(n, T::default());
        let mut iterations = 0;
        let (mut start, mut last) = (f64::NAN, f64::INFINITY);
        loop {
            let residual = at(basis, 0, n);
            residual.copy_from_slice(b);
            if ghosts.any(x.iter().any(|&x| x.into() != 0.0)) {
                multiply(x, work);
                add_scaled(-1.0, work, residual);
            }
            let size = ghosts.norm(residual);
            let relative_residual = size / scale;
            if iterations == 0 {
                start = relative_residual;
            }
            let stagnates = relative_residual > 0.9 * last && restart < most;
            if relative_residual <= tolerance || iterations >= most || relative_residual.is_nan() || stagnates {
                return Progress { iterations, start, relative_residual };
            }
            last = relative_residual;
            scale_by(size.recip(), residual);
            let mut triangle: Vec<Vec<f64>> = Vec::new();
            let mut rotations: Vec<(f64, f64)> = Vec::new();
            let mut g = vec![size];
            while triangle.len() < restart && iterations < most {
                let k = triangle.len();
                let direction = at(directions, k, n);
                direction.copy_from_slice(&basis[k]);
                precondition(direction, (0.5 * tolerance * scale / g[k].abs()).min(1.0));
                multiply(direction, work);
                iterations += 1;
                let (mut column, mut before, mut after) = (vec![0.0; k + 2], 0.0, 0.0);
                for pass in 0..2 {
                    let along = ghosts.orthogonalise(&basis[..=k], work);
                    column.iter_mut().zip(&along).for_each(|(column, h)| *column += h);
                    after = ghosts.norm(work);
                    if pass == 0 {
                        before = along.iter().fold(after, |size, h| size.hypot(*h));
                    }
                    if after > 0.1 * before {
                        break;
                    }
                }
                column[k + 1] = after;
                for (i, &(c, s)) in rotations.iter().enumerate() {
                    let (a, b) = (column[i], column[i + 1]);
                    column[i] = c * a + s * b;
                    column[i + 1] = c * b - s * a;
                }
                let length = column[k].hypot(column[k + 1]);
                if length == 0.0 || !length.is_finite() {
                    break;
                }
                let (c, s) = (column[k] / length, column[k + 1] / length);
                let breakdown = column[k + 1] <= 1e-15 * before;
                if !breakdown {
                    scale_to(column[k + 1].recip(), work, at(basis, k + 1, n));
                }
                rotations.push((c, s));
                column[k] = length;
                column.truncate(k + 1);
                triangle.push(column);
                g.push(-s * g[k]);
                g[k] *= c;
                if breakdown || g[k + 1].abs() <= 0.5 * tolerance * scale {
                    break;
                }
            }
            if triangle.is_empty() {
                return Progress { iterations, start, relative_residual };
            }
            let mut coefficients = vec![0.0; triangle.len()];
            for i in (0..triangle.len()).rev() {
                let known: f64 = (i + 1..triangle.len()).map(|j| triangle[j][i] * coefficients[j]).sum();
                coefficients[i] = (g[i] - known) / triangle[i][i];
            }
            coefficients.iter_mut().for_each(|c| *c = -*c);
            subtract_combination(&directions[..coefficients.len()], &coefficients, x);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::csr::Csr;

    #[test]
    fn converges_on_an_unsymmetric_matrix() {
        let n = 50;
        let mut triplets = Vec::new();
        for i in 0..n {
            triplets.push((i, i, 2.5));
            if i > 0 {
                triplets.push((i, i - 1, -1.3));
                triplets.push((i - 1, i, -0.7));
            }
        }
        let a = Csr::from_triplets(n, &triplets);
        let b: Vec<f64> = (0..n).map(|i| (i % 7) as f64).collect();
        for restart in [10, 60] {
            let mut x = vec![0.0; n];
            let multiply = |x: &[f64], y: &mut [f64]| a.mul_vec(x, y);
            let done = Gmres::default().solve(&Ghosts::none(n), multiply, |_, _| {}, &b, &mut x, restart, 300, 1e-12);
            assert!(done.relative_residual < 1e-12, "{done:?}");
        }
    }
}
