//! Contribution of a point of an element to residual and tangent, from its balance.

use zelus_core::scalar::{Dual, Real};

/// The balance at a point: the factors of the shape functions and of their gradients.
pub(super) trait Pointwise {
    /// The factors a of the shape functions and b of their gradients at a temperature and gradient.
    fn balance<R: Real>(&self, temperature: R, gradient: [R; 3]) -> (R, [R; 3]);
}

/// Takes N_i a + ∇N_i·b, times the weight, off the residual; adds the derivative to the tangent when `lhs` is not empty.
pub(super) fn add<const NODES: usize, const DIM: usize>(
    point: &impl Pointwise,
    [n, values]: [&[f64; NODES]; 2],
    dn: &[[f64; DIM]; NODES],
    weight: f64,
    lhs: &mut [f64],
    rhs: &mut [f64; NODES],
) {
    let value = n.iter().zip(values).map(|(n, value)| n * value).sum::<f64>();
    let gradient = slope(dn, values);
    if lhs.is_empty() {
        let (a, b) = point.balance(value, gradient);
        for i in 0..NODES {
            rhs[i] -= weight * (n[i] * a + dot(&dn[i], &b));
        }
        return;
    }
    let variable = |at: usize, value: f64| Dual::<4>::variable(value, at);
    let (a, b) = point.balance(variable(0, value), std::array::from_fn(|i| variable(i + 1, gradient[i])));
    let flux = b.map(|b| b.value());
    let by = |d: &Dual<4>, j: usize| d.gradient[0] * n[j] + (0..DIM).map(|k| d.gradient[k + 1] * dn[j][k]).sum::<f64>();
    for i in 0..NODES {
        rhs[i] -= weight * (n[i] * a.value() + dot(&dn[i], &flux));
    }
    for j in 0..NODES {
        let (da, db) = (by(&a, j), b.each_ref().map(|b| by(b, j)));
        for i in 0..NODES {
            lhs[i * NODES + j] += weight * (n[i] * da + dot(&dn[i], &db));
        }
    }
}

/// The gradient of values at the nodes.
pub(super) fn slope<const NODES: usize, const DIM: usize>(dn: &[[f64; DIM]; NODES], at: &[f64; NODES]) -> [f64; 3] {
    let mut out = [0.0; 3];
    (0..NODES).for_each(|i| (0..DIM).for_each(|a| out[a] += dn[i][a] * at[i]));
    out
}

/// The sum of products over the directions of the element.
fn dot<const DIM: usize>(gradient: &[f64; DIM], flux: &[f64; 3]) -> f64 {
    gradient.iter().zip(flux).map(|(g, b)| g * b).sum()
}
