//! Nodal results of contact by constraints in an accepted state: the forces of constraints and sliders, by tributary areas.
//!
//! The force of a constraint on its slave node is REACTION there without the components that supports hold; a slider adds its own
//! friction t. Each master takes its weight of minus their sum f. The traction of the slave node is f/A with its tributary area A
//! over the pairs, its pressure −(f·n)/A.

use std::collections::BTreeMap;

use zelus_core::model::ModelPart;
use zelus_core::vector3::{add, dot, scale, sub};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use super::mpc_friction::{MpcFriction, reaction};
use super::node_relation::NodeRelation;
use crate::results::write_states;
use crate::slave_nodes::SlaveStates;
use crate::variables::CONTACT_FORCE;

/// Finds pressures and tractions of the slave nodes, and the forces of contact on the nodes of the part (3 a node).
pub(super) fn find_forces(
    part: &ModelPart,
    states: &mut SlaveStates,
    relations: &BTreeMap<u32, NodeRelation>,
    friction: &MpcFriction,
    mut out: Vec<f64>,
) -> Vec<f64> {
    let sliding: BTreeMap<u32, [f64; 3]> = friction.sliders.iter().flat_map(|block| block.forces()).collect();
    out.clear();
    out.resize(3 * part.nodes.len(), 0.0);
    let (forces, _) = out.as_chunks_mut::<3>();
    states.for_each(|_, state| (state.law.pressure, state.law.traction) = (0.0, [0.0; 3]));
    for (&node, relation) in relations {
        let slave = states.only_at(node);
        let state = &mut states[slave];
        if !state.law.active {
            continue;
        }
        let held = reaction(part, node);
        let is_free = |c: usize| !part.nodes.is_fixed(DISPLACEMENT.component(c as u8), node);
        let of_constraint: [f64; 3] = std::array::from_fn(|c| if is_free(c) { held[c] } else { 0.0 });
        let force = add(of_constraint, sliding.get(&node).copied().unwrap_or_default());
        forces[node as usize] = add(forces[node as usize], force);
        for &(master, weight) in &relation.weights {
            forces[master as usize] = sub(forces[master as usize], scale(force, weight));
        }
        if state.kinematics.area > 0.0 {
            let traction = scale(force, state.kinematics.area.recip());
            state.law.pressure = dot(traction, relation.normal);
            state.law.traction = sub(traction, scale(relation.normal, state.law.pressure));
        }
    }
    out
}

/// Writes CONTACT_STATUS, CONTACT_PRESSURE, CONTACT_TRACTION, CONTACT_GAP, CONTACT_SLIP and CONTACT_FORCE; `sticks` says that nodes may
/// stick, by friction or by a tie.
pub(super) fn write_results(
    part: &mut ModelPart,
    states: &mut SlaveStates,
    relations: &BTreeMap<u32, NodeRelation>,
    friction: &MpcFriction,
    sticks: bool,
) {
    let forces = find_forces(part, states, relations, friction, Vec::new());
    write_states(&mut part.nodes, states, sticks);
    part.nodes.values.values_mut(&CONTACT_FORCE, 0).copy_from_slice(&forces);
}
