//! Restarted flexible GMRES: the preconditioner acts from the right, so that the residual is the true one, and may be another one
//! in each iteration (Saad, SIAM J. Sci. Comput. 14 (1993)).

use super::Progress;
use crate::ghosts::Ghosts;
use crate::vector::{Number, add_scaled};

/// Improves `x` until `‖b - A x‖ ≤ tolerance ‖b‖` or `most` iterations are done.
///
/// `ghosts` says who has which entries; `multiply(x, y)` is `y = A x`, `precondition(x, left)` replaces `x` by an approximation of
/// `A⁻¹ x`, and the iteration would be done if that left no more than the share `left` of `x`.
pub(crate) fn gmres<T: Number>(
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
    let (mut basis, mut directions): (Vec<Vec<T>>, Vec<Vec<T>>) = Default::default();
    let mut work = vec![T::default(); n];
    let mut iterations = 0;
    let (mut start, mut last) = (f64::NAN, f64::INFINITY);
    loop {
        let mut residual = b.to_vec();
        if ghosts.any(x.iter().any(|&x| x.into() != 0.0)) {
            multiply(x, &mut work);
            add_scaled(-1.0, &work, &mut residual);
        }
        let size = ghosts.norm(&residual);
        let relative_residual = size / scale;
        if iterations == 0 {
            start = relative_residual;
        }
        let stagnates = relative_residual > 0.9 * last && restart < most;
        if relative_residual <= tolerance || iterations >= most || relative_residual.is_nan() || stagnates {
            return Progress { iterations, start, relative_residual };
        }
        last = relative_residual;
        basis.clear();
        directions.clear();
        basis.push(scaled(residual, size.recip()));
        let mut triangle: Vec<Vec<f64>> = Vec::new();
        let mut rotations: Vec<(f64, f64)> = Vec::new();
        let mut g = vec![size];
        while triangle.len() < restart && iterations < most {
            let k = triangle.len();
            let mut direction = basis[k].clone();
            precondition(&mut direction, (0.5 * tolerance * scale / g[k].abs()).min(1.0));
            multiply(&direction, &mut work);
            iterations += 1;
            directions.push(direction);
            let before = ghosts.norm(&work);
            let mut column = vec![0.0; k + 2];
            for _ in 0..2 {
                let along = ghosts.orthogonalise(&basis, &mut work);
                column.iter_mut().zip(along).for_each(|(column, h)| *column += h);
                if ghosts.norm(&work) > 0.1 * before {
                    break;
                }
            }
            column[k + 1] = ghosts.norm(&work);
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
                basis.push(scaled(work.clone(), column[k + 1].recip()));
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
        coefficients.iter().zip(&directions).for_each(|(&c, z)| add_scaled(c, z, x));
    }
}

fn scaled<T: Number>(mut vector: Vec<T>, factor: f64) -> Vec<T> {
    vector.iter_mut().for_each(|v| *v = T::from_f64((*v).into() * factor));
    vector
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
            let done = gmres(&Ghosts::none(n), |x, y| a.mul_vec(x, y), |_, _| {}, &b, &mut x, restart, 300, 1e-12);
            assert!(done.relative_residual < 1e-12, "{done:?}");
        }
    }
}
