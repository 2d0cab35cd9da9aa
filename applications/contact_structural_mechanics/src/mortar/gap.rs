//! The weighted gap of the slave nodes of a pair.

use super::operators::Operators;
use zelus_core::scalar::Real;
use zelus_core::vector3::{dot, value};

/// g̃_j = −n_j·(D x¹ − M x²)_j of one pair; sum over the pairs of a node.
/// Negative in penetration; unit of a length times the measure of the facet.
#[inline]
pub fn weighted_gap<T: Real, const NS: usize, const NM: usize>(
    operators: &Operators<T, NS, NM>,
    slave: &[[T; 3]; NS],
    master: &[[T; 3]; NM],
    normals: &[[T; 3]; NS],
) -> [T; NS] {
    let jump = weighted_jump(operators, slave, master);
    std::array::from_fn(|j| -dot(normals[j], jump[j]))
}

/// (D x¹ − M x²)_j, taken relative to a slave node so that a far origin costs no digits.
#[inline]
pub fn weighted_jump<T: Real, const NS: usize, const NM: usize>(
    operators: &Operators<T, NS, NM>,
    slave: &[[T; 3]; NS],
    master: &[[T; 3]; NM],
) -> [[T; 3]; NS] {
    let origin = value(slave[0]);
    let relative = |x: [T; 3]| std::array::from_fn(|c| x[c] - origin[c]);
    operators.jump(&slave.map(relative), &master.map(relative))
}
