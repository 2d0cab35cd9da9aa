//! Geometry of an element: its Gauss rule, and its size along a flow.

use nalgebra::{Matrix3, Vector3};
use zelus_core::geometry::mapping::tangents;
use zelus_core::geometry::{Shape, ShapeTable, local_gradients};
use zelus_structural_mechanics::elements::physical_gradients;

/// √(Σ 1/|∇N_i|²)/n of the corners, at the centre; half of it where edges have nodes in the middle (length).
pub(super) fn stream_size(shape: Shape, x: &[[f64; 3]]) -> f64 {
    let linear = shape.linear();
    let (corners, dim) = (linear.nodes(), linear.dim());
    let centre = linear.cell().centre;
    let mut t = tangents(linear, &x[..corners], centre);
    (dim..3).for_each(|k| t[k][k] = 1.0);
    let Some(inverse) = Matrix3::from(t).try_inverse() else { return 0.0 };
    let mut local = [[0.0; 3]; 27];
    local_gradients(linear, centre, &mut local);
    let lengths = local[..corners].iter().map(|dn| {
        let local = Vector3::from_fn(|k, _| if k < dim { dn[k] } else { 0.0 });
        (inverse.transpose() * local).norm_squared().recip()
    });
    let size = lengths.sum::<f64>().sqrt() / corners as f64;
    if shape == linear { size } else { 0.5 * size }
}

/// # Errors
/// An element that is inverted at a point of its rule.
pub(super) fn check_volume<const NODES: usize, const DIM: usize>(
    rule: &ShapeTable,
    x: &[[f64; 3]; NODES],
) -> Result<(), String> {
    let is_inverted = |dn| physical_gradients::<NODES, DIM>(x, dn).1 <= 0.0;
    if rule.dn::<NODES, DIM>().iter().any(is_inverted) { Err("it is inverted".to_owned()) } else { Ok(()) }
}

/// Order of the rule that integrates products of two shape functions.
pub fn full_order(shape: Shape) -> usize {
    match shape {
        Shape::Tri6 | Shape::Tet10 => 4,
        _ if shape == shape.linear() => 2,
        _ => 3,
    }
}
