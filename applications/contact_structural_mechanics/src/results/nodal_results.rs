//! Nodal results of contact in an accepted state.

use zelus_core::assembly::nodal_vectors;
use zelus_core::diagnostics::Result;
use zelus_core::entities::EntityBlock;
use zelus_core::model::{ModelPart, Nodes};
use zelus_core::vector3::{add, scale};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use crate::interface::SlaveIndex;
use crate::law::NodeState;
use crate::pairs::{ContactBlock, IntegrationState};
use crate::slave_nodes::{NodalCombination, SlaveState, SlaveStates};
use crate::variables::{
    COHESIVE_DAMAGE, CONTACT_FORCE, CONTACT_GAP, CONTACT_PRESSURE, CONTACT_SLIP, CONTACT_STATUS, CONTACT_TRACTION,
};

/// Writes pressures, tractions, gaps, slips and states of slave nodes.
pub(crate) fn write_states(nodes: &mut Nodes, states: &SlaveStates, frictional: bool) {
    let values = &mut nodes.values;
    values.values_mut(&CONTACT_STATUS, 0).fill(-1.0);
    values.values_mut(&CONTACT_PRESSURE, 0).fill(0.0);
    values.values_mut(&CONTACT_GAP, 0).fill(0.0);
    values.values_mut(&CONTACT_TRACTION, 0).fill(0.0);
    if frictional {
        values.values_mut(&CONTACT_SLIP, 0).fill(0.0);
    }
    if states.shows_damage() {
        values.values_mut(&COHESIVE_DAMAGE, 0).fill(0.0);
        for node in states.mesh_nodes() {
            let damages = states.at(node).map(|slave| ([damage(states, slave)], states[slave].kinematics.area));
            values.values_mut(&COHESIVE_DAMAGE, 0)[node as usize] = combined(NodalCombination::Mean, damages)[0];
        }
    }
    // Of several slave nodes at a node: the state that is in contact most, the least gap, and pressures by area.
    for node in states.mesh_nodes() {
        let at = node as usize;
        let own = || states.at(node).map(|slave| &states[slave]);
        values.values_mut(&CONTACT_STATUS, 0)[at] = own().map(|state| status(state, frictional)).fold(0.0, f64::max);
        let gaps = own().map(|state| state.gap().unwrap_or(0.0));
        let least = gaps.clone().fold(f64::INFINITY, f64::min);
        values.values_mut(&CONTACT_GAP, 0)[at] = least;
        let pressures = own().map(|state| ([pressure(state)], state.kinematics.area));
        values.values_mut(&CONTACT_PRESSURE, 0)[at] = combined(NodalCombination::Mean, pressures)[0];
        let tractions = own().map(|state| (traction(state, frictional), state.kinematics.area));
        let traction = combined(NodalCombination::Mean, tractions);
        values.values_mut(&CONTACT_TRACTION, 0)[3 * at..][..3].copy_from_slice(&traction);
        if frictional {
            let slips = own().map(|state| (slip(state), state.kinematics.area));
            let slip = combined(NodalCombination::Mean, slips);
            values.values_mut(&CONTACT_SLIP, 0)[3 * at..][..3].copy_from_slice(&slip);
        }
    }
}

fn in_contact(state: &SlaveState) -> bool {
    state.contact() != NodeState::Inactive
}

/// CONTACT_STATUS of a slave node.
pub(super) fn status(state: &SlaveState, frictional: bool) -> f64 {
    match state.contact() {
        NodeState::Inactive => 0.0,
        NodeState::Stick if frictional => 1.0,
        NodeState::Stick | NodeState::Slip => 2.0,
    }
}

/// CONTACT_PRESSURE of a slave node (force per area).
pub(super) fn pressure(state: &SlaveState) -> f64 {
    if in_contact(state) { -state.law.pressure } else { 0.0 }
}

/// CONTACT_TRACTION of a slave node (force per area).
pub(super) fn traction(state: &SlaveState, frictional: bool) -> [f64; 3] {
    let tangential = if frictional { state.law.traction } else { [0.0; 3] };
    let whole = add(scale(state.kinematics.normal, state.law.pressure), tangential);
    if in_contact(state) { whole } else { [0.0; 3] }
}

/// CONTACT_SLIP of a slave node (length).
pub(super) fn slip(state: &SlaveState) -> [f64; 3] {
    match in_contact(state) && state.kinematics.area > 0.0 {
        true => scale(state.kinematics.weighted_slip, state.kinematics.area.recip()),
        false => [0.0; 3],
    }
}

/// COHESIVE_DAMAGE of a slave node.
pub(super) fn damage(states: &SlaveStates, slave: SlaveIndex) -> f64 {
    states.bond(slave).map_or(0.0, |bond| bond.state.damage)
}

/// The numbers of the only slave node at a mesh node, or the combination of several.
fn combined<const C: usize>(shown: NodalCombination, of: impl Iterator<Item = ([f64; C], f64)> + Clone) -> [f64; C] {
    let mut all = of.clone();
    match (all.next(), all.next()) {
        (Some((only, _)), None) => only,
        _ => shown.combined(of),
    }
}

/// Numbers of a master node: pressure and traction times area, and the area.
const MASTER: usize = 5;

/// Nodes of a facet whose shape functions are negative nowhere: the others have forces without meaning of their own on a part of it.
fn positive_nodes(nodes: usize, space: usize) -> std::ops::Range<usize> {
    match (nodes, space) {
        (3, 2) => 2..3,
        (6, _) => 3..6,
        (8, _) => 4..8,
        (9, _) => 8..9,
        _ => 0..nodes,
    }
}

/// Writes pressures and tractions of master nodes that are no slaves: those of the slave nodes that M spreads, over the area,
/// p_l = Σ_j M_jl p_j / Σ_j M_jl, so that pressure times area is the normal force of contact on the node. Dual functions are negative in
/// places: at the end of contact the range of the slave's pressures limits the mean. Of facets of second order the nodes with positive
/// shape functions carry, and the others take their mean. Tractions act on the master; collective.
pub(crate) fn write_masters(
    part: &mut ModelPart,
    states: &SlaveStates,
    blocks: &[Box<dyn ContactBlock>],
    frictional: bool,
) {
    let space = part.info.domain_size;
    let mut sums = vec![[0.0; MASTER]; part.nodes.len()];
    // the least pressure of the slave nodes of a master node, and the largest with the other sign
    let mut range = vec![[f64::INFINITY; 2]; part.nodes.len()];
    let own = |nodes: &[u32]| part.evaluates_pair(nodes);
    let present = IntegrationState { view: &part.view(), states, own: &own };
    for block in blocks {
        for (at, weights) in block.master_weights(present).into_iter().enumerate() {
            let Some(weights) = weights.filter(|_| block.pairs()[at].overlapping) else { continue };
            let slaves = block.slaves(at);
            let masters = block.masters(at);
            let carriers = positive_nodes(masters.len(), space);
            let mut of_facet = [0.0; MASTER];
            let add = |to: &mut [f64; MASTER], l: usize| {
                for (&slave, row) in slaves.iter().zip(weights.iter()) {
                    let [x, y, z] = traction(&states[slave], frictional);
                    let numbers = [pressure(&states[slave]), -x, -y, -z, 1.0];
                    to.iter_mut().zip(numbers).for_each(|(to, number)| *to += row[l] * number);
                }
            };
            for (&slave, &master) in slaves.iter().flat_map(|slave| masters.iter().map(move |master| (slave, master))) {
                let (own, range) = (pressure(&states[slave]), &mut range[master as usize]);
                *range = [range[0].min(own), range[1].min(-own)];
            }
            for l in carriers.clone() {
                add(&mut sums[masters[l] as usize], l);
                add(&mut of_facet, l);
            }
            for l in (0..masters.len()).filter(|l| !carriers.contains(l)) {
                sums[masters[l] as usize].iter_mut().zip(of_facet).for_each(|(to, number)| *to += number);
            }
        }
    }
    if let Some(share) = &part.share {
        let all = |node: u32, of: &mut Vec<u32>| of.extend(MASTER as u32 * node..MASTER as u32 * (node + 1));
        share.halo.expand(all).sum(sums.as_flattened_mut());
        let both = |node: u32, of: &mut Vec<u32>| of.extend(2 * node..2 * node + 2);
        share.halo.expand(both).least(range.as_flattened_mut());
    }
    let slaves = states.slaves();
    let values = &mut part.nodes.values;
    for (node, [pressure, x, y, z, area]) in sums.into_iter().enumerate() {
        let is_slave = states.at(node as u32).any(|slave| slaves.binary_search(&slave).is_ok());
        if is_slave || area <= 0.0 {
            continue;
        }
        let (mean, [least, most]) = (pressure / area, range[node]);
        let limited = mean.max(least).min(-most);
        let share = if mean * limited > 0.0 { limited / mean } else { 0.0 };
        values.values_mut(&CONTACT_PRESSURE, 0)[node] = limited;
        let traction = [x, y, z].map(|part| share * part / area);
        values.values_mut(&CONTACT_TRACTION, 0)[3 * node..][..3].copy_from_slice(&traction);
    }
}

/// Writes the forces of the blocks of contact on each node they touch; collective.
///
/// # Errors
/// A pair that cannot be computed with.
pub(crate) fn write_forces(part: &mut ModelPart, blocks: &[&dyn EntityBlock]) -> Result<()> {
    let forces = nodal_vectors(part, blocks, &DISPLACEMENT, Vec::new())?;
    part.nodes.values.values_mut(&CONTACT_FORCE, 0).copy_from_slice(&forces);
    Ok(())
}
