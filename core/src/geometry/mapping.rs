//! Maps of a cell with given node coordinates: Jacobians, sizes, normals, local coordinates of a point.
//!
//! Node coordinates `x` are `[x, y, z]` in the node order of the shape; which configuration they belong to is the
//! caller's choice. Normals: a line a → b in the plane has n = (t_y, −t_x), to the right of the direction of travel; a
//! surface has t_1 × t_2. Faces as listed in the reference cells thus point outward.

use nalgebra::{Matrix3, Vector3};

use super::{Shape, ShapeTable, local_gradients, shape_functions};
use crate::vector3::{add, cross, dot, norm, scale, sub};

type Vec3 = [f64; 3];

/// Global coordinates of the local point `xi`.
pub fn position(shape: Shape, x: &[Vec3], xi: [f64; 3]) -> Vec3 {
    let mut n = [0.0; 27];
    shape_functions(shape, xi, &mut n);
    x.iter().zip(&n).fold([0.0; 3], |sum, (x, &n)| add(sum, scale(*x, n)))
}

/// Global coordinates of the centre of the cell.
pub fn centre(shape: Shape, x: &[Vec3]) -> Vec3 {
    position(shape, x, shape.cell().centre)
}

/// Tangents ∂x/∂ξ_k at `xi`, zero for `k` beyond the dimension of the cell.
pub fn tangents(shape: Shape, x: &[Vec3], xi: [f64; 3]) -> [Vec3; 3] {
    let mut dn = [[0.0; 3]; 27];
    local_gradients(shape, xi, &mut dn);
    tangents_from(x, &dn)
}

fn tangents_from(x: &[Vec3], dn: &[[f64; 3]]) -> [Vec3; 3] {
    let mut tangents = [[0.0; 3]; 3];
    for (x, dn) in x.iter().zip(dn) {
        for k in 0..3 {
            tangents[k] = add(tangents[k], scale(*x, dn[k]));
        }
    }
    tangents
}

fn measure(dim: usize, t: &[Vec3; 3]) -> f64 {
    match dim {
        0 => 1.0,
        1 => norm(t[0]),
        2 => norm(cross(t[0], t[1])),
        _ => dot(cross(t[0], t[1]), t[2]),
    }
}

/// Length, area or volume per unit of reference cell at `xi`; signed for solids, positive for lines and surfaces.
pub fn det_jacobian(shape: Shape, x: &[Vec3], xi: [f64; 3]) -> f64 {
    measure(shape.dim(), &tangents(shape, x, xi))
}

/// As [`det_jacobian`] with the sign of the plane: positive for surfaces that run counter-clockwise in x–y.
pub fn signed_det_jacobian(shape: Shape, x: &[Vec3], xi: [f64; 3]) -> f64 {
    signed(shape.dim(), &tangents(shape, x, xi))
}

fn signed(dim: usize, t: &[Vec3; 3]) -> f64 {
    if dim == 2 { t[0][0] * t[1][1] - t[0][1] * t[1][0] } else { measure(dim, t) }
}

fn tangents_at(table: &ShapeTable, g: usize, x: &[Vec3]) -> [Vec3; 3] {
    let mut dn = [[0.0; 3]; 27];
    for (i, dn) in dn[..x.len()].iter_mut().enumerate() {
        *dn = table.dn_at(g, i);
    }
    tangents_from(x, &dn)
}

/// Length, area or volume of the cell, by its default quadrature; 0 for a point.
pub fn domain_size(shape: Shape, x: &[Vec3]) -> f64 {
    if shape.dim() == 0 {
        return 0.0;
    }
    let table = ShapeTable::default_of(shape);
    (0..table.len()).map(|g| table.weight(g) * measure(shape.dim(), &tangents_at(table, g, x))).sum()
}

/// A length typical of the cell: the `dim`-th root of its size, 0 for a point.
pub fn characteristic_length(shape: Shape, x: &[Vec3]) -> f64 {
    match shape.dim() {
        0 => 0.0,
        dim => domain_size(shape, x).abs().powf(1.0 / dim as f64),
    }
}

/// Shortest distance between two nodes of the cell; infinite for a point.
pub fn shortest_node_distance(x: &[Vec3]) -> f64 {
    let pairs = x.iter().enumerate().flat_map(|(i, a)| x[..i].iter().map(move |b| norm(sub(*a, *b))));
    pairs.fold(f64::INFINITY, f64::min)
}

/// Whether the map has a non-positive determinant at a quadrature point or corner: cell turned inside out.
///
/// Solids, and surfaces of a model in the plane `space == 2`, have an orientation; other cells only fail when degenerate.
pub fn is_inverted(shape: Shape, space: usize, x: &[Vec3]) -> bool {
    let dim = shape.dim();
    let det = |t: &[Vec3; 3]| if space == 2 { signed(dim, t) } else { measure(dim, t) };
    let rule = ShapeTable::default_of(shape);
    let corners = ShapeTable::at_nodes(shape);
    let good = |table: &ShapeTable, points: usize| (0..points).all(|g| det(&tangents_at(table, g, x)) > 0.0);
    dim > 0 && !(good(rule, rule.len()) && good(corners, shape.cell().corners()))
}

/// Normal at `xi` with the local area (length) as its magnitude; zero for points and solids.
pub fn area_normal(shape: Shape, x: &[Vec3], xi: [f64; 3]) -> Vec3 {
    let t = tangents(shape, x, xi);
    match shape.dim() {
        1 => [t[0][1], -t[0][0], 0.0],
        2 => cross(t[0], t[1]),
        _ => [0.0; 3],
    }
}

/// Normal with the size of the cell as its magnitude, from its centre: exact for lines, triangles and quadrilaterals with straight
/// edges.
pub fn vector_area(shape: Shape, x: &[Vec3]) -> Vec3 {
    let cell = shape.cell();
    scale(area_normal(shape, x, cell.centre), cell.size())
}

/// Unit normal at `xi`, or `None` where the cell is degenerate or has no normal.
pub fn unit_normal(shape: Shape, x: &[Vec3], xi: [f64; 3]) -> Option<Vec3> {
    let normal = area_normal(shape, x, xi);
    let size = norm(normal);
    (size > 0.0 && size.is_finite()).then(|| scale(normal, 1.0 / size))
}

/// Result of looking for the local coordinates of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projection {
    /// Local coordinates; they may lie outside the reference cell.
    pub xi: [f64; 3],
    /// Distance from the point to its image, 0 for solids.
    pub distance: f64,
}

/// Local coordinates of `point`: its foot on a line or surface (extended beyond the cell), its preimage in a solid.
///
/// `None` when the cell is degenerate or Newton's method does not settle, as for points far from a warped cell.
pub fn local_coordinates(shape: Shape, x: &[Vec3], point: Vec3) -> Option<Projection> {
    let dim = shape.dim();
    let mut xi = shape.cell().centre;
    if dim == 0 {
        return Some(Projection { xi, distance: norm(sub(x[0], point)) });
    }
    // stationary points of |x(ξ) − p|²/2: gradient t_k·r, Hessian t_k·t_l + r·∂²x/∂ξ_k∂ξ_l
    for _ in 0..60 {
        let (image, t, second) = derivatives(shape, x, xi);
        let r = sub(image, point);
        let gradient = Vector3::from_fn(|k, _| dot(t[k], r));
        let inside = |k, l| k < dim && l < dim;
        let gauss = Matrix3::from_fn(|k, l| if inside(k, l) { dot(t[k], t[l]) } else { f64::from(k == l) });
        let full = gauss + Matrix3::from_fn(|k, l| if inside(k, l) { dot(r, second[k][l]) } else { 0.0 });
        let positive = |m: &Matrix3<f64>| m[(0, 0)] > 0.0 && m[(0, 0)] * m[(1, 1)] > m[(0, 1)] * m[(1, 0)];
        // a solid has no residual at its root, and away from a minimum the full Hessian points the wrong way
        let matrix = if dim < 3 && positive(&full) { full } else { gauss };
        let step = matrix.try_inverse()? * gradient;
        let size = step.norm();
        let damping = if size > 2.0 { 2.0 / size } else { 1.0 };
        for k in 0..dim {
            xi[k] -= damping * step[k];
        }
        if !size.is_finite() {
            return None;
        }
        if size < 1e-14 * (1.0 + norm(xi)) || (size < 1e-11 && dim < 3 && step_is_stale(&t, r, dim)) {
            let image = position(shape, x, xi);
            return Some(Projection { xi, distance: if dim == 3 { 0.0 } else { norm(sub(image, point)) } });
        }
    }
    None
}

/// Whether the gradient has reached rounding error, so that further steps only move noise.
fn step_is_stale(t: &[Vec3; 3], r: Vec3, dim: usize) -> bool {
    (0..dim).all(|k| dot(t[k], r).abs() <= 1e-11 * norm(t[k]) * (norm(r) + norm(t[k])))
}

/// Image of `xi`, ∂x/∂ξ_k and ∂²x/∂ξ_k∂ξ_l. No shape function is of higher degree than two in one coordinate, where central
/// differences are exact.
fn derivatives(shape: Shape, x: &[Vec3], xi: [f64; 3]) -> (Vec3, [Vec3; 3], [[Vec3; 3]; 3]) {
    let beside =
        |l: usize, step: f64| tangents(shape, x, std::array::from_fn(|k| xi[k] + if k == l { step } else { 0.0 }));
    let second = [0, 1, 2].map(|l| {
        let (after, before) = (beside(l, 1.0), beside(l, -1.0));
        [0, 1, 2].map(|k| scale(sub(after[k], before[k]), 0.5))
    });
    (position(shape, x, xi), tangents(shape, x, xi), second)
}
