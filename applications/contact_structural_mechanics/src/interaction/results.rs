//! What contact shows of an accepted state at the nodes.

use rayon::prelude::*;
use zelus_core::diagnostics::Result;
use zelus_core::entities::{EntityBlock, LocalSystems, Want};
use zelus_core::model::{ModelPart, Nodes};
use zelus_core::vector3::{add, scale};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use crate::node_state::NodeState;
use crate::slave_states::SlaveStates;
use crate::variables::{CONTACT_FORCE, CONTACT_GAP, CONTACT_PRESSURE, CONTACT_SLIP, CONTACT_STATUS, CONTACT_TRACTION};

/// Entities evaluated at once.
const CHUNK: usize = 4096;

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
    let mut forces = part.ranks.agree(own_forces(part, blocks))?;
    if let Some(share) = &part.share {
        let at = |node: u32, out: &mut Vec<u32>| out.extend((0..3).map(|component| 3 * node + component));
        share.halo.expand(at).sum(&mut forces);
    }
    part.nodes.values.values_mut(&CONTACT_FORCE, 0).copy_from_slice(&forces);
    Ok(())
}

/// Forces of the pairs that this rank evaluates, three numbers a node.
fn own_forces(part: &ModelPart, blocks: &[&dyn EntityBlock]) -> Result<Vec<f64>> {
    let mut forces = vec![0.0; 3 * part.nodes.len()];
    let view = part.view();
    for block in blocks {
        let unknowns = block.unknowns();
        let own: Vec<usize> = (0..block.len()).filter(|&at| part.evaluates_pair(block.nodes(at))).collect();
        let compute = |&at: &usize| -> Result<LocalSystems> {
            let mut out = LocalSystems::default();
            out.reset(1, unknowns.len(), Want::Residual);
            block.local_systems(&view, at..at + 1, Want::Residual, &mut out)?;
            Ok(out)
        };
        for chunk in own.chunks(CHUNK) {
            let systems = chunk.par_iter().map(compute).collect::<Result<Vec<_>>>()?;
            for (&at, mut system) in chunk.iter().zip(systems) {
                let nodes = block.nodes(at);
                let moved = unknowns.iter().zip(system.entity(0).1.iter());
                for (unknown, force) in moved.filter(|(unknown, _)| unknown.variable.column == DISPLACEMENT.name()) {
                    let node = nodes[usize::from(unknown.node)] as usize;
                    forces[3 * node + unknown.variable.component.map_or(0, usize::from)] += force;
                }
            }
        }
    }
    Ok(forces)
}
