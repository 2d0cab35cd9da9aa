//! Shape functions N_i(ξ), each formula once; gradients by forward differentiation of the same formula.

use super::facet_shape::FacetShape;
use super::{ReferenceCell, Shape};
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

/// Barycentric coordinates of a simplex: 1 − Σ x first, then x.
#[inline(always)]
pub(super) fn barycentric<T: Real>(xi: &[T], i: usize) -> T {
    if i == 0 { xi.iter().fold(T::one(), |rest, &x| rest - x) } else { xi[i - 1] }
}

/// (1 + s x)/2 with s = ±1 the coordinate of the node.
#[inline(always)]
pub(super) fn linear<T: Real>(node: f64, x: T) -> T {
    x * (0.5 * node) + 0.5
}

/// x (x + s)/2 for the ends s = ±1, 1 − x² for the middle.
#[inline(always)]
pub(super) fn quadratic<T: Real>(node: f64, x: T) -> T {
    if node == 0.0 { -(x * x) + 1.0 } else { x * (x + node) * 0.5 }
}

/// The product of a factor in each coordinate; `node` are those of the node.
#[inline(always)]
pub(super) fn product<T: Real>(node: &[f64; 3], xi: &[T], factor: impl Fn(f64, T) -> T) -> T {
    (1..xi.len()).fold(factor(node[0], xi[0]), |product, k| product * factor(node[k], xi[k]))
}

/// Corners Π(1 + s_k x_k) (Σ s_k x_k − d + 1)/2^d, edge middles (1 − x_m²) Π(1 + s_k x_k)/2^(d−1).
pub(super) fn serendipity<T: Real>(node: &[f64; 3], xi: &[T]) -> T {
    let product = product(node, xi, |s, x| if s == 0.0 { quadratic(s, x) } else { linear(s, x) });
    if node[..xi.len()].contains(&0.0) {
        return product;
    }
    let sum = (1..xi.len()).fold(xi[0] * node[0], |sum, k| sum + xi[k] * node[k]);
    product * (sum - (xi.len() as f64 - 1.0))
}

/// Quadratic functions of a simplex: L(2L − 1) at a corner, with L its barycentric coordinate.
#[inline(always)]
pub(super) fn quadratic_corner<T: Real>(l: T) -> T {
    l * (l * 2.0 - 1.0)
}

/// Quadratic functions of a simplex: 4 L_a L_b in the middle of the edge between two corners.
#[inline(always)]
pub(super) fn quadratic_middle<T: Real>(a: T, b: T) -> T {
    a * b * 4.0
}

/// Quadratic functions of a simplex, corners and edge middles.
fn quadratic_simplex<T: Real>(cell: &ReferenceCell, xi: &[T], i: usize) -> T {
    match cell.edges.iter().find(|edge| edge.nodes[2] == i) {
        Some(edge) => quadratic_middle(barycentric(xi, edge.nodes[0]), barycentric(xi, edge.nodes[1])),
        None => quadratic_corner(barycentric(xi, i)),
    }
}

/// Quadratic serendipity wedge between the heights c = 0 and 1: triangle edges 4 L_a L_b h, uprights 4 L c (1 − c).
/// Complete in degree 2, unlike Kratos 10.4.4, whose functions are linear in the triangle at half height.
fn quadratic_prism<T: Real>(xi: &[T], [down, c]: [T; 2], i: usize) -> T {
    let (l, next) = (barycentric(xi, i % 3), barycentric(xi, (i + 1) % 3));
    match i / 3 {
        0 => l * down * (l * 2.0 - c * 2.0 - 1.0),
        1 => l * c * (l * 2.0 - down * 2.0 - 1.0),
        2 => l * next * down * 4.0,
        3 => l * c * down * 4.0,
        _ => l * next * c * 4.0,
    }
}
