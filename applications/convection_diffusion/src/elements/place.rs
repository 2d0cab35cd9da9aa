//! What follows from the shape of an element: its Gauss rule, and its size along a flow.

use zelus_core::geometry::mapping::tangents;
use zelus_core::geometry::{Shape, local_gradients};
use zelus_core::vector3::{cross, dot};

/// √(Σ 1/|∇N_i|²)/n of the corners, at the centre; half of it where edges have nodes in the middle (length).
pub(super) fn stream_size(shape: Shape, x: &[[f64; 3]]) -> f64 {
    let linear = shape.linear();
    let (corners, dim) = (linear.nodes(), linear.dim());
    let centre = linear.cell().centre;
    let mut t = tangents(linear, &x[..corners], centre);
    (dim..3).for_each(|k| t[k][k] = 1.0);
    let volume = dot(cross(t[0], t[1]), t[2]);
    let inverse = [cross(t[1], t[2]), cross(t[2], t[0]), cross(t[0], t[1])].map(|row| row.map(|x| x / volume));
    let mut local = [[0.0; 3]; 27];
    local_gradients(linear, centre, &mut local);
    let lengths = local[..corners].iter().map(|dn| {
        let gradient: [f64; 3] = std::array::from_fn(|a| (0..dim).map(|k| dn[k] * inverse[k][a]).sum());
        1.0 / dot(gradient, gradient)
    });
    let size = lengths.sum::<f64>().sqrt() / corners as f64;
    if shape == linear { size } else { 0.5 * size }
}

/// Order of the rule that integrates products of two shape functions.
pub fn full_order(shape: Shape) -> usize {
    match shape {
        Shape::Tri6 | Shape::Tet10 => 4,
        _ if shape == shape.linear() => 2,
        _ => 3,
    }
}
