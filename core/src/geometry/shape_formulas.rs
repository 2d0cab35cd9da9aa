//! Formulas of shape functions N_i(ξ), each once: factors in one coordinate, products, simplices and wedges.

use super::ReferenceCell;
use crate::scalar::Real;

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
pub(super) fn quadratic_simplex<T: Real>(cell: &ReferenceCell, xi: &[T], i: usize) -> T {
    match cell.edges.iter().find(|edge| edge.nodes[2] == i) {
        Some(edge) => quadratic_middle(barycentric(xi, edge.nodes[0]), barycentric(xi, edge.nodes[1])),
        None => quadratic_corner(barycentric(xi, i)),
    }
}

/// Quadratic serendipity wedge between the heights c = 0 and 1: triangle edges 4 L_a L_b h, uprights 4 L c (1 − c).
/// Complete in degree 2, unlike Kratos 10.4.4, whose functions are linear in the triangle at half height.
pub(super) fn quadratic_prism<T: Real>(xi: &[T], [down, c]: [T; 2], i: usize) -> T {
    let (l, next) = (barycentric(xi, i % 3), barycentric(xi, (i + 1) % 3));
    match i / 3 {
        0 => l * down * (l * 2.0 - c * 2.0 - 1.0),
        1 => l * c * (l * 2.0 - down * 2.0 - 1.0),
        2 => l * next * down * 4.0,
        3 => l * c * down * 4.0,
        _ => l * next * c * 4.0,
    }
}

/// Quadratic functions of the triangle times those of the height c from 0 to 1, with down = 1 − c.
pub(super) fn biquadratic_prism<T: Real>(xi: &[T], [down, c]: [T; 2], i: usize) -> T {
    let (l, next) = (barycentric(xi, i % 3), barycentric(xi, (i + 1) % 3));
    let in_triangle = if matches!(i / 3, 0 | 1 | 3) { quadratic_corner(l) } else { quadratic_middle(l, next) };
    let along_height = match i / 3 {
        0 | 2 => quadratic_corner(down),
        1 | 4 => quadratic_corner(c),
        _ => quadratic_middle(down, c),
    };
    in_triangle * along_height
}

/// Height below the apex at which x y/(1 − z) counts as its limit on the axis.
const APEX: f64 = 1e-12;

/// x y/(1 − z) in a pyramid, where |x| and |y| are at most 1 − z.
fn apex_quotient<T: Real>(&[x, y, z]: &[T; 3]) -> T {
    let rest = -z + 1.0;
    if rest.value() < APEX { T::constant(0.0) } else { x * y / rest }
}

/// Rational functions of the pyramid: ((1 + s x)(1 + t y) − z + s t x y z/(1 − z))/4 at the base, z at the apex.
pub(super) fn pyramid<T: Real>(node: &[f64; 3], xi: &[T; 3]) -> T {
    let &[x, y, z] = xi;
    if node[2] == 1.0 {
        return z;
    }
    let [s, t, _] = *node;
    ((x * s + 1.0) * (y * t + 1.0) - z + apex_quotient(xi) * z * (s * t)) * 0.25
}

/// Rational functions of the pyramid with edge middles, complete in degree 2; G. Bedrosian, Int. J. Numer. Meth. Eng. 35 (1992), 95–108.
pub(super) fn quadratic_pyramid<T: Real>(node: &[f64; 3], xi: &[T; 3]) -> T {
    let &[x, y, z] = xi;
    let (rest, quotient) = (-z + 1.0, apex_quotient(xi));
    let [s, t, height] = *node;
    match (height, s, t) {
        (1.0, ..) => quadratic_corner(z),
        (0.0, 0.0, _) => (rest * rest + rest * y * t - x * x - x * quotient * t) * 0.5,
        (0.0, _, 0.0) => (rest * rest + rest * x * s - y * y - y * quotient * s) * 0.5,
        (0.0, ..) => pyramid(node, xi) * (x * s + y * t - 1.0),
        _ => {
            let [s, t] = [s.signum(), t.signum()];
            (rest + x * s + y * t + quotient * (s * t)) * z
        }
    }
}
