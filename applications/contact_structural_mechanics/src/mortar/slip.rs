//! The weighted slip of the slave nodes of a pair, and the tangential directions it is measured in.

use super::gap::{relative, weighted_jump};
use super::operators::Operators;
use super::rotation::FacetRotation;
use zelus_core::geometry::Nodal;
use zelus_core::scalar::Real;
use zelus_core::vector3::{constant, cross, dot, norm, normalised, scale, sub, value};

/// The part of a vector in the plane with unit normal `normal`: P v = v − (v·n) n.
#[inline]
pub fn tangential<T: Real>(vector: [T; 3], normal: [T; 3]) -> [T; 3] {
    sub(vector, scale(normal, dot(vector, normal)))
}

/// Objective weighted slip s_j = P [(D − D°) x¹ − (M − M°) x²]_j since the operators D°, M° were taken. Unaffected by rigid-body motion
/// of the pair; a length times the measure of the facet. It holds the change of P (D x¹ − M x²), too, which is not small where facets
/// stand open beside the node, as at a corner that rolls: tractions do no work on that.
pub fn objective_slip<T: Real>(
    operators: &Operators<T>,
    previous: &Operators<f64>,
    slave: &[[T; 3]],
    master: &[[T; 3]],
    normals: &[[T; 3]],
) -> Nodal<[T; 3]> {
    let origin = value(slave[0]);
    let jump = operators.jump_since(previous, &relative(slave, origin), &relative(master, origin));
    Nodal::new(slave.len(), |j| tangential(jump[j], normals[j]))
}

/// Weighted slip s_j = −P [D δ¹ − M δ²]_j from displacement increments δ.
/// For pairs whose operators hardly change, where the objective form would measure nothing but noise.
pub fn incremental_slip<T: Real>(
    operators: &Operators<T>,
    delta_slave: &[[T; 3]],
    delta_master: &[[T; 3]],
    normals: &[[T; 3]],
) -> Nodal<[T; 3]> {
    let jump = operators.jump(delta_slave, delta_master);
    Nodal::new(normals.len(), |j| tangential(jump[j].map(|x| -x), normals[j]))
}

/// Weighted slip s_j = P [R (D x° − M x°) − (D x − M x)]_j since nodes were at x°, with the rotation R of the slave facet since
/// then and the present operators. `slave` and `master` are positions now and before.
pub fn rotated_slip<T: Real>(
    rotation: &FacetRotation<T>,
    operators: &Operators<T>,
    slave: (&[[T; 3]], &[[f64; 3]]),
    master: (&[[T; 3]], &[[f64; 3]]),
    normals: &[[T; 3]],
) -> Nodal<[T; 3]> {
    let constants = |places: &[[f64; 3]]| Nodal::new(places.len(), |n| constant(places[n]));
    let before = weighted_jump(operators, &constants(slave.1), &constants(master.1));
    let now = weighted_jump(operators, slave.0, master.0);
    Nodal::new(normals.len(), |j| tangential(sub(rotation.apply(before[j]), now[j]), normals[j]))
}

/// Change of an operator beyond which slip is measured objectively (Frobenius norm): `share` of its norm and `area`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OperatorThreshold {
    /// Share of the norm of the operator at the start of the step.
    pub share: f64,
    /// An area; in the plane a length.
    pub area: f64,
}

/// Whether the objective slip is to be used: both operators changed by more than `threshold`.
pub fn is_objective<T: Real>(
    operators: &Operators<T>,
    previous: &Operators<f64>,
    threshold: OperatorThreshold,
) -> bool {
    let exceeds = |change: f64, before: f64| change > threshold.area + threshold.share * before;
    let [d, m] = operators.norms_of_change(previous);
    let [d_before, m_before] = previous.norms();
    exceeds(d, d_before) && exceeds(m, m_before)
}

/// Unit tangent of a slave node: the direction of the tangential part of `vector`, if that is more than its round-off.
/// Otherwise a fixed tangent of `normal`; `dim` is 2 or 3, and in the plane the tangent stays in it.
pub fn tangent(vector: [f64; 3], normal: [f64; 3], dim: usize) -> [f64; 3] {
    let part = tangential(vector, normal);
    if norm(part) > f64::EPSILON * norm(vector) {
        return normalised(part);
    }
    let [x, y, z] = normal;
    let second = normalised(if x.abs() > z.abs() { [y, -x, 0.0] } else { [0.0, z, -y] });
    let first = cross(second, normal);
    if dim == 2 && first[2].abs() > f64::EPSILON { second } else { first }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mortar::tests::Noise;

    #[test]
    fn tangents_are_unit_and_tangential() {
        let mut noise = Noise::new(5);
        for _ in 0..50 {
            for dim in [2, 3] {
                let flat = |v: [f64; 3]| if dim == 2 { [v[0], v[1], 0.0] } else { v };
                let normal = normalised(flat(std::array::from_fn(|_| noise.next())));
                for vector in [[0.0; 3], flat(std::array::from_fn(|_| noise.next()))] {
                    let t = tangent(vector, normal, dim);
                    assert!((dot(t, t) - 1.0).abs() < 1e-14 && dot(t, normal).abs() < 1e-12);
                    assert!(dim == 3 || t[2] == 0.0);
                    assert!(vector == [0.0; 3] || dot(t, vector) > 0.0);
                }
            }
        }
    }
}
