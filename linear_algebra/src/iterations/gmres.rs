//! Restarted flexible GMRES: the preconditioner acts from the right, so that the residual is the true one, and may be another one
//! in each iteration (Saad, SIAM J. Sci. Comput. 14 (1993)).

use super::Progress;
use crate::ghosts::Ghosts;
use crate::vector::{Scalar, add_scaled, clear, copy, scale_by, scale_to, set_length, subtract_combination};

/// The method, with vectors that serve solve after solve.
#[derive(Default)]
pub(crate) struct Gmres<T> {
    basis: Vec<Vec<T>>,
    directions: Vec<Vec<T>>,
    work: Vec<T>,
}

/// The vector of a list at a place, of `n` entries.
fn at<T: Scalar>(list: &mut Vec<Vec<T>>, place: usize, n: usize) -> &mut Vec<T> {
    if list.len() == place {
        list.push(Vec::new());
    }
    set_length(&mut list[place], n);
    &mut list[place]
}

/// Result of a cycle of iterations: the coefficient of each direction.
struct Cycle {
    coefficients: Vec<f64>,
    iterations: usize,
}

impl<T: Scalar> Gmres<T> {
    /// Improves `x` until `‖b - A x‖ ≤ tolerance ‖b‖` or `most` iterations are done.
    ///
    /// `known` is `b - A x` at the start, where that is known; `ghosts` says who has which entries; `multiply(x, y)` is `y = A x`, `precondition(x, left)` replaces `x` by an approximation of
    /// `A⁻¹ x`, and the iteration would be done if that left no more than the share `left` of `x`.
    pub(crate) fn solve(
        &mut self,
        known: Option<&[T]>,
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
            at(&mut self.basis, 0, n).fill(T::default());
            return Progress { iterations: 0, start: 0.0, relative_residual: 0.0 };
        }
        let restart = restart.clamp(1, most.max(1));
        let mut iterations = 0;
        let (mut start, mut last) = (f64::NAN, f64::INFINITY);
        loop {
            let residual = at(&mut self.basis, 0, n);
            match known.filter(|_| iterations == 0) {
                Some(known) => copy(known, residual),
                None => {
                    copy(b, residual);
                    if ghosts.any(x.iter().any(|&x| x.into() != 0.0)) {
                        set_length(&mut self.work, n);
                        multiply(x, &mut self.work);
                        add_scaled(-1.0, &self.work, residual);
                    }
                }
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
            let room = restart.min(most - iterations);
            let goal = 0.5 * tolerance * scale;
            let cycle = self.cycle(ghosts, &mut multiply, &mut precondition, size, room, goal);
            iterations += cycle.iterations;
            if cycle.coefficients.is_empty() {
                scale_by(size, at(&mut self.basis, 0, n));
                return Progress { iterations, start, relative_residual };
            }
            subtract_combination(&self.directions[..cycle.coefficients.len()], &cycle.coefficients, x);
        }
    }

    /// Replaces `b` by an approximation of `A⁻¹ b` that leaves no more than the share `forcing_term` of it; gives the iterations, at most `most`.
    ///
    /// The residual is not computed: the iteration tells it within a factor of two, which is good enough for a preconditioner.
    pub(crate) fn approximate(
        &mut self,
        ghosts: &Ghosts,
        multiply: impl FnMut(&[T], &mut [T]),
        precondition: impl FnMut(&mut [T], f64),
        b: &mut [T],
        most: usize,
        forcing_term: f64,
    ) -> usize {
        let size = ghosts.norm(b);
        if size == 0.0 || !size.is_finite() || most == 0 {
            b.fill(T::default());
            return 0;
        }
        copy(b, at(&mut self.basis, 0, b.len()));
        let cycle = self.cycle(ghosts, multiply, precondition, size, most, 0.5 * forcing_term * size);
        clear(b);
        subtract_combination(&self.directions[..cycle.coefficients.len()], &cycle.coefficients, b);
        cycle.iterations
    }

    /// Residual b − A x of the last solve.
    pub(crate) fn residual(&self) -> &[T] {
        &self.basis[0]
    }

    /// At most `most` iterations from a residual of this `size`, the first of the basis, until no more than `goal` of it is left.
    /// No coefficients where nothing is to be gained.
    fn cycle(
        &mut self,
        ghosts: &Ghosts,
        mut multiply: impl FnMut(&[T], &mut [T]),
        mut precondition: impl FnMut(&mut [T], f64),
        size: f64,
        most: usize,
        goal: f64,
    ) -> Cycle {
        let Self { basis, directions, work } = self;
        let n = basis[0].len();
        set_length(work, n);
        scale_by(size.recip(), &mut basis[0]);
        let mut triangle: Vec<Vec<f64>> = Vec::new();
        let mut rotations: Vec<(f64, f64)> = Vec::new();
        let (mut g, mut iterations) = (vec![size], 0);
        while iterations < most {
            let k = triangle.len();
            let direction = at(directions, k, n);
            copy(&basis[k], direction);
            precondition(direction, (goal / g[k].abs()).min(1.0));
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
            if breakdown || g[k + 1].abs() <= goal {
                break;
            }
        }
        let mut coefficients = vec![0.0; triangle.len()];
        for i in (0..triangle.len()).rev() {
            let known: f64 = (i + 1..triangle.len()).map(|j| triangle[j][i] * coefficients[j]).sum();
            coefficients[i] = (g[i] - known) / triangle[i][i];
        }
        coefficients.iter_mut().for_each(|c| *c = -*c);
        Cycle { coefficients, iterations }
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
            let done =
                Gmres::default().solve(None, &Ghosts::none(n), multiply, |_, _| {}, &b, &mut x, restart, 300, 1e-12);
            assert!(done.relative_residual < 1e-12, "{done:?}");
        }
    }

    #[test]
    fn what_is_known_of_the_start_is_taken_and_what_is_left_is_told() {
        let a = Csr::from_triplets(3, &[(0, 0, 2.0), (1, 1, 3.0), (2, 2, 4.0), (0, 2, 1.0)]);
        let (b, mut x) = ([4.0, 3.0, 8.0], vec![1.0, 1.0, 1.9]);
        let mut products = 0;
        let multiply = |x: &[f64], y: &mut [f64]| {
            products += 1;
            a.mul_vec(x, y);
        };
        let known = [4.0 - 3.9, 0.0, 8.0 - 7.6];
        let mut method = Gmres::default();
        let done = method.solve(Some(&known), &Ghosts::none(3), multiply, |_, _| {}, &b, &mut x, 9, 9, 1e-13);
        assert_eq!(products, done.iterations + 1);
        let expected = [1.0, 1.0, 2.0];
        assert!(x.iter().zip(expected).all(|(x, e)| (x - e).abs() < 1e-12), "{x:?}");
        assert!(method.residual().iter().all(|r| r.abs() < 1e-12), "{:?}", method.residual());

        // The right-hand side is made of two eigenvectors.
        let (none, product) = (Ghosts::none(3), |x: &[f64], y: &mut [f64]| a.mul_vec(x, y));
        let mut approximation = b.to_vec();
        assert_eq!(method.approximate(&none, product, |_, _| {}, &mut approximation, 9, 1e-13), 2);
        assert!(approximation.iter().zip(expected).all(|(x, e)| (x - e).abs() < 1e-12), "{approximation:?}");
    }
}
