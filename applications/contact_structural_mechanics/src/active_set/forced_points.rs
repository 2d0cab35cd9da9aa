//! Integration points that decide on contact by their own pressure and traction: how they are held in contact for one solve.
//!
//! Between bodies that only touch no point presses, and nothing would keep them apart in the first solve of a step. Points that
//! slide may come beyond the opposite bound in one solve, and back in the next.

use std::collections::BTreeSet;

use zelus_core::vector3::{dot, norm};

use crate::interface::SlaveIndex;
use crate::law::{Decision, NodeState};
use crate::slave_nodes::SlaveStates;
use crate::tolerances::Tolerances;

/// Step start: holds active slave nodes in contact where the traction decides nothing: those without any, and all of interfaces
/// that no traction presses on.
///
/// `slaves` are the slave nodes of each interface.
pub(crate) fn hold_touching(states: &mut SlaveStates, slaves: &[Vec<SlaveIndex>], tolerances: Tolerances) {
    release(states);
    for nodes in slaves {
        let pressure =
            |states: &SlaveStates, node: SlaveIndex| -dot(states[node].law.trial, states[node].kinematics.normal);
        let presses = nodes.iter().any(|&node| tolerances.exceeds(pressure(states, node), 0.0, false));
        for &node in nodes {
            let touches = !presses || !tolerances.exceeds(pressure(states, node).abs(), 0.0, false);
            states[node].law.forced_active = touches && states[node].law.active;
        }
    }
}

/// Holds the points around these nodes in contact until the next solve.
pub(crate) fn hold(states: &mut SlaveStates, nodes: &BTreeSet<SlaveIndex>) {
    nodes.iter().for_each(|&node| states[node].law.forced_active = true);
}

/// Holds the points around active nodes in contact; `false` where no node is active or all of them are held already.
pub(crate) fn hold_active(states: &mut SlaveStates) -> bool {
    let mut any = false;
    states.for_each(|_, state| {
        any |= state.law.active && !state.law.forced_active;
        state.law.forced_active |= state.law.active;
    });
    any
}

/// Lets all points decide by their pressure and traction.
pub(crate) fn release(states: &mut SlaveStates) {
    states.for_all(|state| (state.law.forced_active, state.law.forced_stick) = (false, false));
}

/// Lets points stick until the next solve around nodes that slide back: one solve took them from one bound beyond the other.
pub(crate) fn hold_turned(
    states: &mut SlaveStates,
    decisions: &mut [(SlaveIndex, Decision)],
    before: &[NodeState],
    tolerances: Tolerances,
) {
    let counts = |traction: [f64; 3]| tolerances.exceeds(norm(traction), 0.0, false);
    for ((node, decision), &was) in decisions.iter_mut().zip(before) {
        let state = &mut states[*node];
        let slides = was == NodeState::Slip && decision.state == NodeState::Slip;
        let turned = dot(state.law.traction, decision.traction) < 0.0;
        if slides && counts(state.law.traction) && counts(decision.traction) && turned {
            decision.slip_changed = true;
            state.law.forced_stick = true;
        }
    }
}
