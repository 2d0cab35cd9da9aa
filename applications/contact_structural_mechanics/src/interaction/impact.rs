//! Contact in motion with inertia: which nodes it is near to, and what energy a step makes of closing and opening.
//!
//! A trapezoidal step does the work ½ (p_n + p_{n+1}) (g̃_{n+1} − g̃_n) at a node, where contact does none: p g̃ = 0 at both ends.
//! What is left, ½ (p_n g̃_{n+1} − p_{n+1} g̃_n), is of a node that opens or closes within the step.

use std::collections::BTreeSet;

use zelus_core::entities::Outer;
use zelus_core::model::ModelPart;
use zelus_core::strategies::ENERGY_OF_MOTION;
use zelus_core::vector3::norm;
use zelus_structural_mechanics::variables::VELOCITY;

use super::pairing::Pairing;
use crate::pairs::{Family, Multiplier};
use crate::solver::IMPACT_TOLERANCE;
use crate::variables::{NODAL_AREA, NODAL_H, WEIGHTED_GAP};

/// Slave nodes within a mesh size of a master, or what they may move in two steps, and the nodes of those masters, ascending.
/// Those `before` stay until they are twice as far.
pub(super) fn near_nodes(part: &ModelPart, pairing: &Pairing, slaves: &[u32], before: &[u32]) -> Vec<u32> {
    let Some(velocity) = part.nodes.history.get(VELOCITY.name()) else { return Vec::new() };
    let nodes = pairing.nodes();
    let fastest = nodes.iter().map(|&node| norm(velocity.vector(0, node as usize))).fold(0.0, f64::max);
    let motion = 2.0 * fastest * part.info.delta_time;
    let (gaps, areas) = (part.nodes.history.values(&WEIGHTED_GAP, 0), part.nodes.values.values(&NODAL_AREA, 0));
    let sizes = part.nodes.values.values(&NODAL_H, 0);
    let is_near = |&&node: &&u32| {
        let at = node as usize;
        let reach = (sizes[at] + motion) * if before.binary_search(&node).is_ok() { 2.0 } else { 1.0 };
        areas[at] > 0.0 && gaps[at] < reach * areas[at]
    };
    let mut near: BTreeSet<u32> = slaves.iter().filter(is_near).copied().collect();
    let mut masters = BTreeSet::new();
    for pair in pairing.blocks.iter().flat_map(|block| block.pairs()).filter(|pair| pair.overlapping) {
        if pairing.slave(pair.key).nodes.iter().any(|node| near.contains(node)) {
            masters.extend(pairing.master(pair.key).nodes.iter().copied());
        }
    }
    near.append(&mut masters);
    near.into_iter().collect()
}

/// Share of the error of a step that a shorter one must have taken away for others to be tried.
const LEAST_GAIN: f64 = 0.1;

/// Whether the step is too coarse for the nodes that closed or opened in it.
///
/// `start` are the weighted gaps at its start. `before` is the error of the last attempt at this step, zero at first: where a
/// shorter step has not helped, as where supports jump, still shorter ones do not either.
pub(super) fn coarse_impact(
    part: &ModelPart,
    slaves: &[u32],
    family: &Family,
    scale_factor: f64,
    start: &[f64],
    before: &mut f64,
) -> Outer {
    let (tolerance, energy) = (part.info.value_or(IMPACT_TOLERANCE, 0.0), part.info.value_or(ENERGY_OF_MOTION, 0.0));
    if tolerance == 0.0 || energy == 0.0 {
        return Outer::Done;
    }
    let history = &part.nodes.history;
    let pressure = |node: u32, level: usize| match family.multiplier {
        Multiplier::None | Multiplier::Body => 0.0,
        Multiplier::Scalar(variable) => scale_factor * history.values(variable, level)[node as usize].abs(),
        Multiplier::Vector(variable) => {
            scale_factor * history.get(variable.name()).map_or(0.0, |field| norm(field.vector(level, node as usize)))
        }
    };
    let gaps = history.values(&WEIGHTED_GAP, 0);
    let gap = |gaps: &[f64], node: u32| gaps.get(node as usize).map_or(0.0, |gap| gap.max(0.0));
    let work = |&node: &u32| 0.5 * (pressure(node, 0) * gap(start, node) + pressure(node, 1) * gap(gaps, node));
    let error = slaves.iter().map(work).sum::<f64>() / energy;
    if error <= tolerance || (*before > 0.0 && error > (1.0 - LEAST_GAIN) * *before) {
        return Outer::Done;
    }
    *before = error;
    Outer::Coarse(format!("contact closes or opens within it, which is {error:.1e} of the energy of motion"))
}
