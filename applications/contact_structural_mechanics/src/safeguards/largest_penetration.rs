//! Slave nodes in contact that lie too deep in the master.

use zelus_core::diagnostics::{coordinates, counted};
use zelus_core::model::ModelPart;

use crate::slave_nodes::SlaveStates;
use crate::variables::NODAL_H;

/// Remedy of steps that iterate.
pub(crate) const STIFFER: &str = "raise the penalty (\"stiffness_factor\" of \"advance_ALM_parameters\", or a manual \"penalty\"), use alm_contact_process";
/// Remedy of explicit steps, whose largest stable penalty grows as 1/Δt².
pub(crate) const SHORTER: &str =
    "shorten \"time_step\", which lets the penalty be stiffer, or refine the mesh of both sides";

/// Why a state cannot be accepted in which a node in contact is deeper in the master than `most` of its mesh size, 0: any; depths up to
/// `least` are round-off.
pub(crate) fn too_deep(part: &ModelPart, states: &SlaveStates, most: f64, least: f64, remedy: &str) -> Option<String> {
    if most <= 0.0 {
        return None;
    }
    let sizes = part.nodes.values.values(&NODAL_H, 0);
    // A node without a mesh size has no share that could be judged.
    let share = |node: u32, depth: f64| if sizes[node as usize] > 0.0 { depth / sizes[node as usize] } else { 0.0 };
    let depths = states.iter().filter(|(_, state)| state.law.active);
    let depths = depths.map(|(slave, state)| (states.mesh_node(slave), -state.gap().unwrap_or(0.0)));
    let deep: Vec<(u32, f64)> = depths.filter(|&(node, depth)| depth > least && share(node, depth) > most).collect();
    let (node, depth) = deep.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))?;
    let nodes = counted(deep.len(), "slave node in contact is", "slave nodes in contact are");
    let place = coordinates(part.nodes.initial[node as usize]);
    Some(format!(
        "{nodes} inside the master by more than {most} of their mesh size, node {} at {place} by {depth:.3e} ({:.2} of it): {remedy}, or allow more by \"largest_penetration\" in \"contact_settings\"",
        part.nodes.ids[node as usize],
        share(node, depth)
    ))
}
