//! Shape functions N_i(ξ), each formula once; gradients by forward differentiation of the same formula.

use std::ops::{Add, Mul, Sub};

use super::Shape;

/// What a polynomial needs of a number: `f64`, every [`crate::scalar::Real`], and dual numbers of those.
/// Mixed arithmetic with `f64` treats the plain number as a constant.
pub trait Algebra:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
}

impl<T> Algebra for T where
    T: Copy
        + Add<Output = T>
        + Sub<Output = T>
        + Mul<Output = T>
        + Add<f64, Output = T>
        + Sub<f64, Output = T>
        + Mul<f64, Output = T>
{
}

/// A value with its derivatives with respect to the three local coordinates; nests for second derivatives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Jet<T> {
    pub(super) value: T,
    pub(super) d: [T; 3],
}

impl<T: Algebra> Jet<T> {
    /// The local coordinates as independent variables.
    pub(super) fn coordinates(xi: [T; 3]) -> [Self; 3] {
        let zero = xi[0] * 0.0;
        [0, 1, 2].map(|k| {
            let mut d = [zero; 3];
            d[k] = zero + 1.0;
            Jet { value: xi[k], d }
        })
    }
}

impl<T: Algebra> Add for Jet<T> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Jet { value: self.value + b.value, d: [0, 1, 2].map(|k| self.d[k] + b.d[k]) }
    }
}

impl<T: Algebra> Sub for Jet<T> {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Jet { value: self.value - b.value, d: [0, 1, 2].map(|k| self.d[k] - b.d[k]) }
    }
}

impl<T: Algebra> Mul for Jet<T> {
    type Output = Self;
    #[expect(clippy::suspicious_arithmetic_impl, reason = "the product rule is a sum")]
    fn mul(self, b: Self) -> Self {
        Jet { value: self.value * b.value, d: [0, 1, 2].map(|k| self.d[k] * b.value + self.value * b.d[k]) }
    }
}

impl<T: Algebra> Add<f64> for Jet<T> {
    type Output = Self;
    fn add(self, b: f64) -> Self {
        Jet { value: self.value + b, d: self.d }
    }
}

impl<T: Algebra> Sub<f64> for Jet<T> {
    type Output = Self;
    fn sub(self, b: f64) -> Self {
        Jet { value: self.value - b, d: self.d }
    }
}

impl<T: Algebra> Mul<f64> for Jet<T> {
    type Output = Self;
    fn mul(self, b: f64) -> Self {
        Jet { value: self.value * b, d: self.d.map(|d| d * b) }
    }
}

/// Values of all shape functions of `shape` at `xi`, written to the first entries of `n`.
///
/// # Panics
/// If `n` is shorter than the number of nodes.
pub fn shape_functions<T: Algebra>(shape: Shape, xi: [T; 3], n: &mut [T]) {
    let [a, b, c] = xi;
    let one = a * 0.0 + 1.0;
    let points = shape.cell().points;
    let n = &mut n[..points.len()];
    match shape {
        Shape::Point1 => n[0] = one,
        Shape::Line2 | Shape::Quad4 | Shape::Hex8 => tensor(n, points, xi, shape.dim(), linear),
        Shape::Line3 | Shape::Quad9 | Shape::Hex27 => tensor(n, points, xi, shape.dim(), quadratic),
        Shape::Quad8 | Shape::Hex20 => serendipity(n, points, xi, shape.dim()),
        Shape::Tri3 => n.copy_from_slice(&[one - a - b, a, b]),
        Shape::Tet4 => n.copy_from_slice(&[one - a - b - c, a, b, c]),
        Shape::Tri6 => quadratic_simplex(n, &[one - a - b, a, b], shape),
        Shape::Tet10 => quadratic_simplex(n, &[one - a - b - c, a, b, c], shape),
        Shape::Prism6 => {
            for (i, l) in [one - a - b, a, b].into_iter().enumerate() {
                n[i] = l * (one - c);
                n[i + 3] = l * c;
            }
        }
        Shape::Prism15 => quadratic_prism(n, [one - a - b, a, b], c),
    }
}

/// Gradients ∂N_i/∂ξ_k of all shape functions of `shape` at `xi`, as `dn[i][k]`; entries beyond its dimension are 0.
///
/// # Panics
/// If `dn` is shorter than the number of nodes.
pub fn local_gradients<T: Algebra>(shape: Shape, xi: [T; 3], dn: &mut [[T; 3]]) {
    let jets = Jet::coordinates(xi);
    let mut values = [jets[0]; 27];
    shape_functions(shape, jets, &mut values);
    for (gradient, value) in dn[..shape.nodes()].iter_mut().zip(&values) {
        *gradient = value.d;
    }
}

/// (1 + s x)/2 with s = ±1 the coordinate of the node.
fn linear<T: Algebra>(node: f64, x: T) -> T {
    x * (0.5 * node) + 0.5
}

/// x (x + s)/2 for the ends s = ±1, 1 − x² for the middle.
fn quadratic<T: Algebra>(node: f64, x: T) -> T {
    if node == 0.0 { x * x * -1.0 + 1.0 } else { x * (x + node) * 0.5 }
}

fn tensor<T: Algebra>(n: &mut [T], points: &[[f64; 3]], xi: [T; 3], dim: usize, factor: fn(f64, T) -> T) {
    for (n, point) in n.iter_mut().zip(points) {
        *n = (1..dim).fold(factor(point[0], xi[0]), |product, k| product * factor(point[k], xi[k]));
    }
}

/// Corners Π(1 + s_k x_k) (Σ s_k x_k − d + 1)/2^d, edge middles (1 − x_m²) Π(1 + s_k x_k)/2^(d−1).
fn serendipity<T: Algebra>(n: &mut [T], points: &[[f64; 3]], xi: [T; 3], dim: usize) {
    for (n, point) in n.iter_mut().zip(points) {
        let factor = |k: usize| if point[k] == 0.0 { quadratic(0.0, xi[k]) } else { linear(point[k], xi[k]) };
        let product = (1..dim).fold(factor(0), |product, k| product * factor(k));
        let corner = !point[..dim].contains(&0.0);
        let sum = (1..dim).fold(xi[0] * point[0], |sum, k| sum + xi[k] * point[k]);
        *n = if corner { product * (sum - (dim as f64 - 1.0)) } else { product };
    }
}

/// Corners L(2L − 1), edge middles 4 L_a L_b, with L the barycentric coordinates.
fn quadratic_simplex<T: Algebra>(n: &mut [T], l: &[T], shape: Shape) {
    for (i, &l) in l.iter().enumerate() {
        n[i] = l * (l * 2.0 - 1.0);
    }
    for edge in shape.cell().edges {
        n[edge.nodes[2]] = l[edge.nodes[0]] * l[edge.nodes[1]] * 4.0;
    }
}

/// Quadratic serendipity wedge with height `c` in [0, 1]: triangle edges 4 L_a L_b h, uprights 4 L c (1 − c).
/// Complete in degree 2, unlike Kratos 10.4.4, whose functions are linear in the triangle at half height.
fn quadratic_prism<T: Algebra>(n: &mut [T], l: [T; 3], c: T) {
    let down = c * -1.0 + 1.0;
    for i in 0..3 {
        let next = (i + 1) % 3;
        n[i] = l[i] * down * (l[i] * 2.0 - c * 2.0 - 1.0);
        n[i + 3] = l[i] * c * (l[i] * 2.0 - down * 2.0 - 1.0);
        n[i + 6] = l[i] * l[next] * down * 4.0;
        n[i + 9] = l[i] * c * down * 4.0;
        n[i + 12] = l[i] * l[next] * c * 4.0;
    }
}
