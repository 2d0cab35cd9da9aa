//! What contact shows of an accepted state at the nodes.

use zelus_core::assembly::nodal_vectors;
use zelus_core::diagnostics::Result;
use zelus_core::entities::EntityBlock;
use zelus_core::model::{ModelPart, Nodes};
use zelus_core::vector3::{add, scale};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use crate::node_state::NodeState;
use crate::slave_states::SlaveStates;
use crate::variables::{CONTACT_FORCE, CONTACT_GAP, CONTACT_PRESSURE, CONTACT_SLIP, CONTACT_STATUS, CONTACT_TRACTION};

/// Writes pressures, tractions, gaps, slips and states of slave nodes.
pub(super) fn write_states(nodes: &mut Nodes, states: &SlaveStates, frictional: bool) {
    let values = &mut nodes.values;
    values.values_mut(&CONTACT_STATUS, 0).fill(-1.0);
    values.values_mut(&CONTACT_PRESSURE, 0).fill(0.0);
    values.values_mut(&CONTACT_GAP, 0).fill(0.0);
    values.values_mut(&CONTACT_TRACTION, 0).fill(0.0);
    if frictional {
        values.values_mut(&CONTACT_SLIP, 0).fill(0.0);
    }
    for (node, state) in states.iter() {
        let at = node as usize;
        let contact = state.contact();
        values.values_mut(&CONTACT_STATUS, 0)[at] = match contact {
            NodeState::Inactive => 0.0,
            NodeState::Stick if frictional => 1.0,
            NodeState::Stick | NodeState::Slip => 2.0,
        };
        values.values_mut(&CONTACT_GAP, 0)[at] = state.gap().unwrap_or(0.0);
        if contact == NodeState::Inactive {
            continue;
        }
        values.values_mut(&CONTACT_PRESSURE, 0)[at] = -state.pressure;
        let tangential = if frictional { state.traction } else { [0.0; 3] };
        let traction = add(scale(state.normal, state.pressure), tangential);
        values.values_mut(&CONTACT_TRACTION, 0)[3 * at..][..3].copy_from_slice(&traction);
        if frictional && state.area > 0.0 {
            let slip = scale(state.weighted_slip, state.area.recip());
            values.values_mut(&CONTACT_SLIP, 0)[3 * at..][..3].copy_from_slice(&slip);
        }
    }
}

/// Writes what the blocks of contact do to each node they touch; collective.
///
/// # Errors
/// A pair that cannot be computed with.
pub(super) fn write_forces(part: &mut ModelPart, blocks: &[&dyn EntityBlock]) -> Result<()> {
    let forces = nodal_vectors(part, blocks, &DISPLACEMENT, Vec::new())?;
    part.nodes.values.values_mut(&CONTACT_FORCE, 0).copy_from_slice(&forces);
    Ok(())
}
