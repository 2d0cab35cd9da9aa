//! Shape functions N_i(ξ) of all shapes; gradients by forward differentiation of the same formulas.

use super::Shape;
use super::facet_shape::FacetShape;
use super::shape_formulas::{
    barycentric, biquadratic_prism, linear, product, pyramid, quadratic, quadratic_prism, quadratic_pyramid,
    quadratic_simplex, serendipity,
};
use crate::scalar::{Dual, Real};

/// Values of all shape functions of `shape` at `xi`, written to the first entries of `n`.
///
/// # Panics
/// If `n` is shorter than the number of nodes.
pub fn shape_functions<T: Real>(shape: Shape, xi: [T; 3], n: &mut [T]) {
    let [a, b, c] = xi;
    let cell = shape.cell();
    let n = &mut n[..cell.points.len()];
    let down = -c + 1.0;
    match shape {
        Shape::Point1 => n[0] = T::one(),
        Shape::Tet4 => fill(n, |i| barycentric(&xi, i)),
        Shape::Tet10 => fill(n, |i| quadratic_simplex(cell, &xi, i)),
        Shape::Prism6 => fill(n, |i| barycentric(&[a, b], i % 3) * if i < 3 { down } else { c }),
        Shape::Prism15 => fill(n, |i| quadratic_prism(&[a, b], [down, c], i)),
        Shape::Prism18 => fill(n, |i| biquadratic_prism(&[a, b], [down, c], i)),
        Shape::Pyramid5 => fill(n, |i| pyramid(&cell.points[i], &xi)),
        Shape::Pyramid13 => fill(n, |i| quadratic_pyramid(&cell.points[i], &xi)),
        Shape::Hex8 => fill(n, |i| product(&cell.points[i], &xi, linear)),
        Shape::Hex20 => fill(n, |i| serendipity(&cell.points[i], &xi)),
        Shape::Hex27 => fill(n, |i| product(&cell.points[i], &xi, quadratic)),
        _ => n.copy_from_slice(&FacetShape::of(shape).expect("lines and surfaces are facets").values([a, b])),
    }
}

/// Gradients ∂N_i/∂ξ_k of all shape functions of `shape` at `xi`, as `dn[i][k]`; entries beyond its dimension are 0.
///
/// # Panics
/// If `dn` is shorter than the number of nodes.
pub fn local_gradients(shape: Shape, xi: [f64; 3], dn: &mut [[f64; 3]]) {
    let mut values = [Dual::default(); 27];
    shape_functions(shape, [0, 1, 2].map(|k| Dual::<3>::variable(xi[k], k)), &mut values);
    for (gradient, value) in dn[..shape.nodes()].iter_mut().zip(&values) {
        *gradient = value.gradient;
    }
}

fn fill<T>(n: &mut [T], value: impl Fn(usize) -> T) {
    n.iter_mut().enumerate().for_each(|(i, n)| *n = value(i));
}
