//! The pairs of a deck by name, and the contact states of their slave nodes at the end of a step.

use std::collections::{BTreeMap, BTreeSet};

use zelus_core::entities::{Join, PairState};
use zelus_core::model::ModelPart;
use zelus_core::vector3::norm;

use crate::interface::{Interface, SlaveIndex};
use crate::law::NodeState;
use crate::search::facing;
use crate::slave_nodes::{SlaveState, SlaveStates};

/// Parts of the pairs of a deck by key: all of them, and those on the slave side.
pub(crate) type PartsOfPairs<'a> = (&'a BTreeMap<String, Vec<String>>, &'a BTreeMap<String, Vec<String>>);

/// The pairs of these interfaces; nodes in contact slide where there is no friction, and `heat` is the dissipation of a slave node in the
/// step (energy); `slaves` are the slave nodes of each interface. No depth up to `least` counts. A slave node of several
/// pairs counts in the first.
pub(crate) fn pair_states(
    interfaces: &[Interface],
    parts: PartsOfPairs<'_>,
    (states, slaves): (&SlaveStates, &[Vec<SlaveIndex>]),
    frictional: bool,
    least: f64,
    heat: impl Fn(SlaveIndex, &SlaveState) -> f64,
) -> Vec<PairState> {
    let mut counted = BTreeSet::new();
    let of_pair = |(interface, slaves): (&Interface, &Vec<SlaveIndex>)| {
        let mut out = PairState { name: name(&interface.key, parts), ..PairState::default() };
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
