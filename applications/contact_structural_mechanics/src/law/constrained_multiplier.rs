//! Equations of slave nodes that supports hold together with the master surface opposite them.
//!
//! Along a component in which both sides are held nothing can move, so that the equation of the multiplier there has no unknown that
//! could obey it. On a plane of symmetry the traction has no such component: the multiplier there stays zero. Elsewhere it follows the
//! multipliers of the facet's other nodes, so that constant tractions are transmitted exactly: its dual function is shared out among
//! them. The remaining equations of the node:
//! - stick: the components that are free;
//! - slip: k g̃ along m, the free part of the normal, and the law of friction along e, the free tangent; e and m are unit
//!   vectors, and e is at right angles to m and n.

use super::node_state::{MultiplierConstraint, MultiplierConstraints, NodeState};
use super::{Multiplier, SlaveNode};
use zelus_core::scalar::Real;
use zelus_core::vector3::{dot, normalised, scale, sub};

/// Square of the free part of a normal below which nothing can move along it.
const LEAST_FREE: f64 = 1e-2;

/// The free part of a unit normal, as a unit vector; zero if there is next to none.
pub fn free_normal<T: Real>(normal: [T; 3], constraints: MultiplierConstraints) -> [T; 3] {
    let free = free(normal, constraints);
    if dot(free, free).value() < LEAST_FREE { [T::zero(); 3] } else { normalised(free) }
}

/// The part of a vector along which a node that stays in contact can slide.
pub fn along_free_tangents<T: Real>(vector: [T; 3], normal: [T; 3], constraints: MultiplierConstraints) -> [T; 3] {
    let (vector, normal) = (free(vector, constraints), free_normal(normal, constraints));
    sub(vector, scale(normal, dot(vector, normal)))
}

fn free<T: Real>(vector: [T; 3], constraints: MultiplierConstraints) -> [T; 3] {
    let own = constraints.axes.components(vector);
    constraints.axes.vector(std::array::from_fn(|c| if constraints.rules[c].is_still() { T::zero() } else { own[c] }))
}

/// Share with which a multiplier whose facet has no free node is kept, beside facets that it can follow.
const WITHOUT_FREE_NODE: f64 = 1e-6;

/// Replaces equations of constrained components, each with the weight k² A/c of its node. `rows` are those of the law.
pub fn constrain<T: Real>(
    rows: &mut [[T; 3]],
    kind: Multiplier,
    normals: &[[T; 3]],
    multipliers: &[[T; 3]],
    nodes: &[SlaveNode],
) {
    for (j, node) in nodes.iter().enumerate() {
        let constraints = node.constraints;
        if constraints.are_none() || !node.state.is_active() {
            continue;
        }
        let row = rows[j];
        if matches!(kind, Multiplier::Vector(_)) && node.state == NodeState::Slip && constraints.any_still() {
            let (n, m) = (normals[j], free_normal(normals[j], constraints));
            let tangent = along_free_tangents(row, n, constraints);
            let gap = dot(n, row);
            rows[j] = std::array::from_fn(|c| tangent[c] + m[c] * gap);
        }
        // Of a scalar multiplier the first component counts, whatever the axes.
        let axes = constraints.axes;
        let mut row = axes.components(rows[j]);
        for c in 0..3 {
            let own = axes.component(c, multipliers[j]);
            row[c] = match constraints.rules[c] {
                MultiplierConstraint::Free => continue,
                MultiplierConstraint::ConstantInStick | MultiplierConstraint::HeldByOtherFace
                    if node.state == NodeState::Slip =>
                {
                    continue;
                }
                MultiplierConstraint::Constant
                | MultiplierConstraint::ConstantInStick
                | MultiplierConstraint::HeldByOtherFace => (T::constant(own.value()) - own) * node.constraint_weight,
                MultiplierConstraint::Crosspoint => {
                    let free = (0..nodes.len()).filter(|&k| nodes[k].constraints.is_free_along(c, axes));
                    let (mut sum, mut count, mut any) = (T::zero(), 0.0, false);
                    for k in free {
                        any = true;
                        if nodes[k].state.is_active() {
                            sum += axes.component(c, multipliers[k]);
                            count += 1.0;
                        }
                    }
                    match (any, count > 0.0) {
                        (false, _) => (T::constant(own.value()) - own) * (WITHOUT_FREE_NODE * node.constraint_weight),
                        (true, false) => -own * node.constraint_weight,
                        (true, true) => (sum / count - own) * node.constraint_weight,
                    }
                }
            };
        }
        rows[j] = axes.vector(row);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::SupportAxes;

    #[test]
    fn nodes_slide_along_what_is_free() {
        let slope = [0.6, 0.8, 0.0];
        let by_rules = |rules| MultiplierConstraints { rules, ..Default::default() };
        let wall = by_rules([MultiplierConstraint::Crosspoint, MultiplierConstraint::Free, MultiplierConstraint::Free]);
        // In the plane a node in contact whose component x is held cannot slide; in space it slides along z.
        let slides = along_free_tangents([0.8, -0.6, 2.0], slope, wall);
        assert!((0..3).all(|c| (slides[c] - [0.0, 0.0, 2.0][c]).abs() < 1e-15), "{slides:?}");
        assert_eq!(free_normal(slope, wall), [0.0, 1.0, 0.0]);
        // A node that moves with its supports is not restricted, and a clamp leaves no free normal.
        assert_eq!(
            along_free_tangents([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], by_rules([MultiplierConstraint::ConstantInStick; 3])),
            [1.0, 0.0, 0.0]
        );
        assert_eq!(free_normal(slope, by_rules([MultiplierConstraint::Crosspoint; 3])), [0.0; 3]);
        // The same wall on axes of its own: nothing is free along the slope's own direction.
        let axes = SupportAxes([[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]]);
        let turned = MultiplierConstraints { axes, ..wall };
        let slides = along_free_tangents([0.8, -0.6, 2.0], slope, turned);
        assert!((0..3).all(|c| (slides[c] - [0.0, 0.0, 2.0][c]).abs() < 1e-15), "{slides:?}");
        let normal = free_normal(slope, turned);
        assert!((0..3).all(|c| (normal[c] - slope[c]).abs() < 1e-15), "{normal:?}");
    }
}
