//! Restarted GMRES with a preconditioner from the right, so that its residual is the true one.

use super::Progress;
use crate::ghosts::Ghosts;
use crate::vector::add_scaled;

/// Improves `x` until `‖b - A x‖ ≤ tolerance ‖b‖` or `most` iterations are done.
///
/// `ghosts` says who has which entries; `multiply(x, y)` is `y = A x`, `precondition(x)` replaces `x` by an approximation of `A⁻¹ x`.
pub(crate) fn gmres(
    ghosts: &Ghosts,
    mut multiply: impl FnMut(&[f64], &mut [f64]),
    mut precondition: impl FnMut(&mut [f64]),
    b: &[f64],
    x: &mut [f64],
    restart: usize,
    most: usize,
    tolerance: f64,
) -> Progress {
    let n = b.len();
    let scale = ghosts.norm(b);
    if scale == 0.0 {
        x.fill(0.0);
        return Progress { iterations: 0, start: 0.0, relative_residual: 0.0 };
    }
    let restart = restart.clamp(1, most.max(1));
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut work = vec![0.0; n];
    let mut iterations = 0;
    let (mut start, mut last) = (f64::NAN, f64::INFINITY);
    loop {
        multiply(x, &mut work);
        let residual: Vec<f64> = b.iter().zip(&work).map(|(b, ax)| b - ax).collect();
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
        basis.push(residual.iter().map(|r| r / size).collect());
        let mut triangle: Vec<Vec<f64>> = Vec::new();
        let mut rotations: Vec<(f64, f64)> = Vec::new();
        let mut g = vec![size];
        while triangle.len() < restart && iterations < most {
            let k = triangle.len();
            let mut direction = basis[k].clone();
            precondition(&mut direction);
            multiply(&direction, &mut work);
            iterations += 1;
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
                basis.push(work.iter().map(|w| w / column[k + 1]).collect());
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
        work.fill(0.0);
        coefficients.iter().zip(&basis).for_each(|(&c, v)| add_scaled(c, v, &mut work));
        precondition(&mut work);
        add_scaled(1.0, &work, x);
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
            let done = gmres(&Ghosts::none(n), |x, y| a.mul_vec(x, y), |_| {}, &b, &mut x, restart, 300, 1e-12);
            assert!(done.relative_residual < 1e-12, "{done:?}");
        }
    }
}
