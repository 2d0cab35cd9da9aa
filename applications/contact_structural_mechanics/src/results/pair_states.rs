//! The pairs of a deck by name, and the contact states of their slave nodes at the end of a step.

use std::collections::{BTreeMap, BTreeSet};

use zelus_core::entities::{Join, PairState};
use zelus_core::model::ModelPart;
use zelus_core::vector3::{add, dot, norm, scale, sub};

use crate::interface::{Interface, SlaveIndex};
use crate::law::NodeState;
use crate::search::facing;
use crate::slave_nodes::{SlaveState, SlaveStates};

/// Parts of the pairs of a deck by key: all of them, and those on the slave side.
pub(crate) type PartsOfPairs<'a> = (&'a BTreeMap<String, Vec<String>>, &'a BTreeMap<String, Vec<String>>);

/// The pairs of these interfaces; nodes in contact slide where there is no friction, and `heat` is the dissipation of a slave node in the
/// step (energy), `spring` the energy in its springs, where it has any; `slaves` are the slave nodes of each interface. No depth up to `least`
/// counts. A slave node of several pairs counts in the first.
pub(crate) fn pair_states(
    interfaces: &[Interface],
    parts: PartsOfPairs<'_>,
    (states, slaves): (&SlaveStates, &[Vec<SlaveIndex>]),
    frictional: bool,
    least: f64,
    heat: impl Fn(SlaveIndex, &SlaveState) -> f64,
    spring: Option<&dyn Fn(&SlaveState) -> f64>,
) -> Vec<PairState> {
    let mut counted = BTreeSet::new();
    let of_pair = |(interface, slaves): (&Interface, &Vec<SlaveIndex>)| {
        let stored = spring.map(|_| 0.0);
        let mut out = PairState { name: name(&interface.key, parts), stored, ..PairState::default() };
        for slave in slaves.iter().copied().filter(|slave| counted.insert(*slave)) {
            let state = &states[slave];
            match state.contact() {
                NodeState::Inactive => out.open += 1,
                NodeState::Stick if frictional => out.sticking += 1,
                NodeState::Stick | NodeState::Slip => out.slipping += 1,
            }
            if frictional {
                out.dissipated += heat(slave, state);
            }
            out.stored = out.stored.zip(spring).map(|(sum, spring)| sum + spring(state));
            let depth = -state.gap().unwrap_or(0.0);
            if depth > out.deepest.map_or(least, |(_, deepest)| deepest) {
                out.deepest = Some((states.mesh_node(slave), depth));
            }
        }
        out
    };
    interfaces.iter().zip(slaves).map(of_pair).collect()
}

/// Energy that friction with this traction has dissipated over this slip on the area of a node.
pub(crate) fn heat(traction: [f64; 3], slip: [f64; 3], area: f64) -> f64 {
    norm(traction) * norm(slip) * area
}

/// Energy in the springs of a slave node in contact by penalty, ½ (ε g² + t²/(κ ε)) A with its gap g and its tangential traction t;
/// `tangent_factor` is κ.
pub(crate) fn spring_energy(state: &SlaveState, tangent_factor: f64) -> f64 {
    let gap = state.gap().filter(|_| state.law.active).unwrap_or(0.0);
    let traction = if state.law.active { norm(state.law.traction) } else { 0.0 };
    let penalty = state.parameters.penalty;
    if penalty > 0.0 {
        0.5 * state.kinematics.area * (penalty * gap * gap + traction * traction / (tangent_factor * penalty))
    } else {
        0.0
    }
}

/// Energy that friction with an elastic slip has dissipated at a slave node over the `slip` of the step: the mean of the tractions at its
/// ends times the inelastic slip, s − (t − t°)/(κ ε).
pub(crate) fn inelastic_heat(state: &SlaveState, slip: [f64; 3], tangent_factor: f64) -> f64 {
    let (now, before, penalty) = (state.law.traction, state.last.history_traction, state.parameters.penalty);
    if !state.law.active || penalty <= 0.0 {
        return 0.0;
    }
    let inelastic = sub(slip, scale(sub(now, before), (tangent_factor * penalty).recip()));
    0.5 * state.kinematics.area * dot(add(now, before), inelastic)
}

/// Name of a pair for reports: its key, the slave parts and those they meet.
pub(crate) fn name(key: &str, (parts, slaves): PartsOfPairs<'_>) -> String {
    let all = parts.get(key).map_or(&[][..], Vec::as_slice);
    let own = slaves.get(key).map_or(&[][..], Vec::as_slice);
    let others: Vec<&str> = all.iter().filter(|part| !own.contains(part)).map(String::as_str).collect();
    match (own.is_empty(), others.is_empty()) {
        (false, false) => format!("{key}: {} on {}", own.join(" and "), others.join(" and ")),
        _ => format!("{key}: {}", all.join(" and ")),
    }
}

/// Where these interfaces join bodies before the first step; `None` where each search decides on their sides.
pub(crate) fn joins(part: &ModelPart, interfaces: &[Interface], tied: bool, friction: bool) -> Option<Vec<Join>> {
    if interfaces.iter().any(|interface| interface.open) {
        return None;
    }
    let places = interfaces.iter().flat_map(|interface| facing(part, interface));
    Some(places.map(|(nodes, normal)| Join { nodes, normal: (!tied).then_some(normal), friction }).collect())
}
