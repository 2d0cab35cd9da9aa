//! Integration points that decide on contact by their own pressure and traction: how they are taken hold of for one solve.
//!
//! Between bodies that only touch no point presses, and nothing would keep them apart in the first solve of a step. Points that
//! slide may come beyond the opposite bound in one solve, and back in the next.

use std::collections::BTreeSet;

use zelus_core::model::flags::ACTIVE;
use zelus_core::model::{ModelPart, variables::NORMAL};
use zelus_core::vector3::{dot, norm};

use super::activation::vector_at;
use crate::active_set::Decision;
use crate::formulations::NodeState;
use crate::interface::{Interface, Roles};
use crate::resolution::Resolution;
use crate::variables::{AUGMENTED_TANGENT_CONTACT_PRESSURE, HELD_IN_CONTACT, HELD_IN_STICK, TRIAL_TRACTION};

/// Step start: takes hold of the active slave nodes of interfaces where nothing presses.
pub(super) fn hold_open_interfaces(part: &mut ModelPart, interfaces: &[Interface], resolution: Resolution) {
    let tractions = part.nodes.values.values(&TRIAL_TRACTION, 0);
    let presses = |&node: &u32| {
        let normal = part.nodes.history.get(NORMAL.name()).map_or([0.0; 3], |field| field.vector(0, node as usize));
        resolution.exceeds(-dot(vector_at(tractions, node as usize), normal), 0.0, false)
    };
    let mut held = BTreeSet::new();
    for interface in interfaces {
        let nodes = interface.nodes_of(Roles::Slave);
        if !nodes.iter().any(presses) {
            held.extend(nodes.into_iter().filter(|&node| part.nodes.flags.is(ACTIVE, node as usize)));
        }
    }
    release(part);
    hold(part, &held);
}

/// Takes hold of the points around these nodes until the next solve.
pub(super) fn hold(part: &mut ModelPart, nodes: &BTreeSet<u32>) {
    let column = part.nodes.values.values_mut(&HELD_IN_CONTACT, 0);
    nodes.iter().for_each(|&node| column[node as usize] = 1.0);
}

/// Takes hold of the points around active nodes; `false` where all of them are held already, or there are none.
pub(super) fn hold_active(part: &mut ModelPart, slaves: &[u32]) -> bool {
    let held = part.nodes.values.values(&HELD_IN_CONTACT, 0);
    let is_free = |&node: &u32| part.nodes.flags.is(ACTIVE, node as usize) && held[node as usize] == 0.0;
    let free: BTreeSet<u32> = slaves.iter().copied().filter(is_free).collect();
    hold(part, &free);
    !free.is_empty()
}

/// Lets all points decide by their pressure and traction.
pub(super) fn release(part: &mut ModelPart) {
    for variable in [&HELD_IN_CONTACT, &HELD_IN_STICK] {
        part.nodes.values.values_mut(variable, 0).fill(0.0);
    }
}

/// Lets points stick until the next solve around nodes that slide back: one solve took them from one bound beyond the other.
pub(super) fn hold_turned(
    part: &mut ModelPart,
    decisions: &mut [(u32, Decision)],
    before: &[NodeState],
    resolution: Resolution,
) {
    let earlier = part.nodes.values.values(&AUGMENTED_TANGENT_CONTACT_PRESSURE, 0);
    let mut turned = Vec::new();
    for ((node, decision), &was) in decisions.iter_mut().zip(before) {
        let slides = was == NodeState::Slip && decision.state == NodeState::Slip;
        let before = vector_at(earlier, *node as usize);
        let counts = |traction: [f64; 3]| resolution.exceeds(norm(traction), 0.0, false);
        if slides && counts(before) && counts(decision.traction) && dot(before, decision.traction) < 0.0 {
            decision.slip_changed = true;
            turned.push(*node as usize);
        }
    }
    let column = part.nodes.values.values_mut(&HELD_IN_STICK, 0);
    turned.into_iter().for_each(|node| column[node] = 1.0);
}
