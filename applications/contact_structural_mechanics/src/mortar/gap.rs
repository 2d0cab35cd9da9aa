//! The weighted gap of the slave nodes of a pair.

use super::operators::Operators;
use zelus_core::geometry::Nodal;
use zelus_core::scalar::Real;
use zelus_core::vector3::{dot, value};

/// g̃_j = −n_j·(D x¹ − M x²)_j of one pair; sum over the pairs of a node.
/// Negative in penetration; unit of a length times the measure of the facet.
pub fn weighted_gap<T: Real>(
    operators: &Operators<T>,
    slave: &[[T; 3]],
    master: &[[T; 3]],
    normals: &[[T; 3]],
) -> Nodal<T> {
    let jump = weighted_jump(operators, slave, master);
    Nodal::new(slave.len(), |j| -dot(normals[j], jump[j]))
}

/// (D x¹ − M x²)_j, taken relative to a slave node so that a far origin costs no digits.
pub fn weighted_jump<T: Real>(operators: &Operators<T>, slave: &[[T; 3]], master: &[[T; 3]]) -> Nodal<[T; 3]> {
    let origin = value(slave[0]);
    operators.jump(&relative(slave, origin), &relative(master, origin))
}

/// Positions as they are seen from an origin.
pub(super) fn relative<T: Real>(places: &[[T; 3]], origin: [f64; 3]) -> Nodal<[T; 3]> {
    Nodal::new(places.len(), |n| std::array::from_fn(|c| places[n][c] - origin[c]))
}
