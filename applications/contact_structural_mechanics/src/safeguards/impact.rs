//! Contact in motion with inertia: nodes close to contact, and the energy error of closing and opening in a step.
//!
//! A trapezoidal step does the work ½ (p_n + p_{n+1}) (g̃_{n+1} − g̃_n) at a node, where contact does none: p g̃ = 0 at both ends.
//! The rest, ½ (p_n g̃_{n+1} − p_{n+1} g̃_n), is that of a node which opens or closes within the step.

use std::collections::BTreeSet;

use zelus_core::entities::OuterLoop;
use zelus_core::model::ModelPart;
use zelus_core::strategies::ENERGY_OF_MOTION;
use zelus_core::vector3::norm;
use zelus_structural_mechanics::variables::VELOCITY;

use crate::interface::SlaveIndex;
use crate::slave_nodes::{SlaveState, SlaveStates};
use crate::variables::NODAL_H;

/// Slave nodes within a mesh size of a master, or within their motion of two steps, and `masters` of those slave nodes, ascending.
/// `nodes` are those of the interfaces. Nodes of `before` stay until they are twice as far.
pub(crate) fn near_nodes(
    part: &ModelPart,
    nodes: &[u32],
    states: &SlaveStates,
    masters: impl FnOnce(&BTreeSet<u32>) -> BTreeSet<u32>,
    before: &[u32],
) -> Vec<u32> {
    let Some(velocity) = part.nodes.history.get(VELOCITY.name()) else { return Vec::new() };
    let fastest = nodes.iter().map(|&node| norm(velocity.vector(0, node as usize))).fold(0.0, f64::max);
    let motion = 2.0 * fastest * part.info.delta_time;
    let sizes = part.nodes.values.values(&NODAL_H, 0);
    let is_near = |(slave, state): &(SlaveIndex, &SlaveState)| {
        let node = states.mesh_node(*slave);
        let distance = (sizes[node as usize] + motion) * if before.binary_search(&node).is_ok() { 2.0 } else { 1.0 };
        state.kinematics.area > 0.0 && state.kinematics.weighted_gap < distance * state.kinematics.area
    };
    let mut near: BTreeSet<u32> = states.iter().filter(is_near).map(|(slave, _)| states.mesh_node(slave)).collect();
    let mut of_near = masters(&near);
    near.append(&mut of_near);
    near.into_iter().collect()
}

/// Share of the error of a step that a shorter one must have taken away for others to be tried.
const LEAST_GAIN: f64 = 0.1;

/// Whether the step is too coarse for the nodes that closed or opened in it.
///
/// `pressure` is that of a slave node at the end of the step (level 0) and at its start (1), as an absolute value. `tolerance` is the
/// share of the energy of motion that the step may make or lose; 0: any. `start` are the weighted gaps at its start. `before` is the
/// error of the last attempt at this step, zero at first: where a shorter step has not helped, as where supports jump, still shorter
/// ones do not either.
pub(crate) fn coarse_impact(
    part: &ModelPart,
    states: &SlaveStates,
    pressure: impl Fn(SlaveIndex, usize) -> f64,
    tolerance: f64,
    (start, before): (&[f64], &mut f64),
) -> OuterLoop {
    let energy = part.info.value_or(ENERGY_OF_MOTION, 0.0);
    if tolerance == 0.0 || energy == 0.0 {
        return OuterLoop::Done;
    }
    let began = |slave: SlaveIndex| start.get(slave.place()).map_or(0.0, |gap| gap.max(0.0));
    let work = |(slave, state): (SlaveIndex, &SlaveState)| {
        0.5 * (pressure(slave, 0) * began(slave) + pressure(slave, 1) * state.kinematics.weighted_gap.max(0.0))
    };
    let error = states.iter().map(work).sum::<f64>() / energy;
    if error <= tolerance || (*before > 0.0 && error > (1.0 - LEAST_GAIN) * *before) {
        return OuterLoop::Done;
    }
    *before = error;
    OuterLoop::StepTooLarge(format!("contact closes or opens within it, which is {error:.1e} of the energy of motion"))
}
