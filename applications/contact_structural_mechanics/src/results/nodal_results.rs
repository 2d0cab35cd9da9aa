//! Nodal results of contact in an accepted state.

use zelus_core::assembly::nodal_vectors;
use zelus_core::diagnostics::Result;
use zelus_core::entities::EntityBlock;
use zelus_core::model::{ModelPart, Nodes};
use zelus_core::vector3::{add, scale};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use crate::law::NodeState;
use crate::slave_nodes::{NodalCombination, SlaveState, SlaveStates};
use crate::variables::{CONTACT_FORCE, CONTACT_GAP, CONTACT_PRESSURE, CONTACT_SLIP, CONTACT_STATUS, CONTACT_TRACTION};

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

/// The numbers of the only slave node at a mesh node, or the combination of several.
fn combined<const C: usize>(shown: NodalCombination, of: impl Iterator<Item = ([f64; C], f64)> + Clone) -> [f64; C] {
    let mut all = of.clone();
    match (all.next(), all.next()) {
        (Some((only, _)), None) => only,
        _ => shown.combined(of),
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
