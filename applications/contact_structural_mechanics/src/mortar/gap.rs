//! The weighted gap of the slave nodes of a pair.

use super::operators::Operators;
use zelus_core::geometry::FacetShape;
use zelus_core::scalar::Real;
use zelus_core::vector3::{dot, value};

/// g̃_j = −n_j·(D x¹ − M x²)_j of one pair; sum over the pairs of a node.
/// Negative in penetration; unit of a length times the measure of the facet.
#[inline]
pub fn weighted_gap<T: Real, S: FacetShape, M: FacetShape>(
    operators: &Operators<T, S, M>,
    slave: &S::Nodal<[T; 3]>,
    master: &M::Nodal<[T; 3]>,
    normals: &S::Nodal<[T; 3]>,
) -> S::Nodal<T> {
    let jump = weighted_jump(operators, slave, master);
    S::nodal(|j| -dot(normals[j], jump[j]))
}

/// (D x¹ − M x²)_j, taken relative to a slave node so that a far origin costs no digits.
#[inline]
pub fn weighted_jump<T: Real, S: FacetShape, M: FacetShape>(
    operators: &Operators<T, S, M>,
    slave: &S::Nodal<[T; 3]>,
    master: &M::Nodal<[T; 3]>,
) -> S::Nodal<[T; 3]> {
    let origin = value(slave[0]);
    let relative = |x: [T; 3]| std::array::from_fn(|c| x[c] - origin[c]);
    operators.jump(&S::map(slave, relative), &M::map(master, relative))
}
