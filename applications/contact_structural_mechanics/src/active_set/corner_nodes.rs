//! Multipliers of mesh nodes that stick to several faces at once.
//!
//! A mesh node on several patches has a multiplier for each, and where it sticks to all of them more equations than displacements.
//! Normals of all faces in contact hold it first; then each face that sticks, the largest first, holds it along those of its tangents along
//! which nothing holds it yet. Along its other tangents its friction is statically indeterminate, and the multiplier keeps its value.
//! A face that slides obeys the law of friction, which determines its multiplier.

use zelus_core::vector3::{cross, dot, norm, normalised, scale, sub};

use crate::interface::SlaveIndex;
use crate::law::{MultiplierConstraint, MultiplierConstraints, NodeState, SupportAxes};
use crate::slave_nodes::SlaveStates;

/// Part of a unit vector beyond the directions that are held, below which it is held by them.
const HELD: f64 = 0.1;

/// Decides the constrained multipliers of mesh nodes with several slave nodes in the present states; those of supports stay.
pub(crate) fn constrain(states: &mut SlaveStates) {
    for corner in states.at_corners() {
        let all: Vec<SlaveIndex> = corner.map(|place| SlaveIndex(place as u32)).collect();
        for &slave in &all {
            let constraints = &mut states[slave].law.constraints;
            if constraints.rules.contains(&MultiplierConstraint::HeldByOtherFace) {
                *constraints = MultiplierConstraints::default();
            }
        }
        let is_in_contact = |slave: &SlaveIndex| states[*slave].law.active && states[*slave].kinematics.area > 0.0;
        let mut faces: Vec<SlaveIndex> = all.into_iter().filter(is_in_contact).collect();
        if faces.len() > 1 {
            faces.sort_by(|&a, &b| states[b].kinematics.area.total_cmp(&states[a].kinematics.area));
            hold(states, &faces);
        }
    }
}

/// Constrains the multipliers of faces of one mesh node that are in contact, in the order in which they hold it.
fn hold(states: &mut SlaveStates, faces: &[SlaveIndex]) {
    let normals: Vec<[f64; 3]> = faces.iter().map(|&face| states[face].kinematics.normal).collect();
    // An orthonormal basis of the directions along which the node is held.
    let mut held: Vec<[f64; 3]> = Vec::new();
    normals.iter().for_each(|&normal| add_direction(&mut held, normal));
    for (&face, &normal) in faces.iter().zip(&normals) {
        if states[face].contact() != NodeState::Stick || !states[face].law.constraints.are_none() {
            continue;
        }
        // Of the tangents one along which the node is held, where there is only one, and one across it.
        let along = held.iter().map(|&direction| sub(direction, scale(normal, dot(direction, normal))));
        let first = along.max_by(|a, b| norm(*a).total_cmp(&norm(*b))).unwrap_or([0.0; 3]);
        if norm(first) < HELD {
            continue;
        }
        let first = normalised(first);
        let second = cross(normal, first);
        let rule = |tangent| {
            if norm(beyond(&held, tangent)) < HELD {
                MultiplierConstraint::HeldByOtherFace
            } else {
                MultiplierConstraint::Free
            }
        };
        let rules = [MultiplierConstraint::Free, rule(first), rule(second)];
        states[face].law.constraints = MultiplierConstraints { rules, axes: SupportAxes([normal, first, second]) };
        [first, second].into_iter().for_each(|tangent| add_direction(&mut held, tangent));
    }
}

/// The part of a unit vector across an orthonormal basis.
fn beyond(basis: &[[f64; 3]], vector: [f64; 3]) -> [f64; 3] {
    basis.iter().fold(vector, |rest, &direction| sub(rest, scale(direction, dot(rest, direction))))
}

fn add_direction(basis: &mut Vec<[f64; 3]>, vector: [f64; 3]) {
    let rest = beyond(basis, vector);
    if norm(rest) >= HELD {
        basis.push(normalised(rest));
    }
}
