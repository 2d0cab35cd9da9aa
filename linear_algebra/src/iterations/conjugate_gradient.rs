//! Preconditioned conjugate gradients.

use super::Progress;
use crate::ghosts::Ghosts;
use crate::vector::add_scaled;

/// Improves `x` until `‖b - A x‖ ≤ tolerance ‖b‖` or `most` iterations are done; stops early on an indefinite matrix.
///
/// `ghosts` says who has which entries; `multiply(x, y)` is `y = A x`, `precondition(x)` replaces `x` by a symmetric approximation of `A⁻¹ x`.
pub(crate) fn conjugate_gradient(
    ghosts: &Ghosts,
    mut multiply: impl FnMut(&[f64], &mut [f64]),
    mut precondition: impl FnMut(&mut [f64]),
    b: &[f64],
    x: &mut [f64],
    most: usize,
    tolerance: f64,
) -> Progress {
    let scale = ghosts.norm(b);
    if scale == 0.0 {
        x.fill(0.0);
        return Progress { iterations: 0, start: 0.0, relative_residual: 0.0 };
    }
    let mut image = vec![0.0; b.len()];
    multiply(x, &mut image);
    let mut residual: Vec<f64> = b.iter().zip(&image).map(|(b, ax)| b - ax).collect();
    let mut direction = vec![0.0; b.len()];
    let mut preconditioned = residual.clone();
    let mut old_product = 1.0;
    let mut iterations = 0;
    let start = ghosts.norm(&residual) / scale;
    loop {
        let relative_residual = ghosts.norm(&residual) / scale;
        if relative_residual <= tolerance || iterations >= most || relative_residual.is_nan() {
            return Progress { iterations, start, relative_residual };
        }
        preconditioned.copy_from_slice(&residual);
        precondition(&mut preconditioned);
        let product = ghosts.dot(&residual, &preconditioned);
        let beta = if iterations == 0 { 0.0 } else { product / old_product };
        direction.iter_mut().zip(&preconditioned).for_each(|(p, z)| *p = z + beta * *p);
        multiply(&direction, &mut image);
        let curvature = ghosts.dot(&direction, &image);
        if curvature <= 0.0 || product <= 0.0 || !curvature.is_finite() {
            return Progress { iterations, start, relative_residual };
        }
        let alpha = product / curvature;
        add_scaled(alpha, &direction, x);
        add_scaled(-alpha, &image, &mut residual);
        old_product = product;
        iterations += 1;
    }
}
