//! Columns of multipliers at mesh nodes, beside the multipliers of slave nodes.
//!
//! Unknowns are those of slave nodes. Results show a column of mesh nodes: the multiplier of the only slave node there, or the mean
//! of several by area. A deck or a program may write that column before the run or between steps, and the slave nodes take it up.

use zelus_core::model::ModelPart;
use zelus_core::vector3::{dot, scale};

use crate::law::Multiplier;
use crate::slave_states::{Shown, SlaveStates, SlaveTable};

/// Columns of mesh nodes with the multipliers of slave nodes: node, and the three components of its entry.
fn shown(part: &ModelPart, states: &SlaveStates, multiplier: Multiplier) -> Vec<(u32, [f64; 3])> {
    let mut out: Vec<(u32, [f64; 3])> = Vec::with_capacity(states.len());
    for slave in states.all() {
        let node = states.mesh_node(slave);
        if out.last().is_some_and(|(last, _)| *last == node) {
            continue;
        }
        let own =
            states.at(node).map(|slave| (multiplier.value(&part.slave_nodes, states.owner(slave)), states[slave].area));
        let several = states.at(node).nth(1).is_some();
        let value =
            if several { Shown::Mean.combined(own) } else { multiplier.value(&part.slave_nodes, states.owner(slave)) };
        out.push((node, value));
    }
    out
}

/// Writes the column of mesh nodes.
pub(super) fn export(part: &mut ModelPart, states: &SlaveStates, multiplier: Multiplier) {
    let Some((name, components)) = multiplier.column() else { return };
    let shown = shown(part, states, multiplier);
    let Some(field) = part.nodes.history.get_mut(name) else { return };
    for (node, value) in shown {
        let at = components * node as usize;
        field.levels[0][at..at + components].copy_from_slice(&value[..components]);
    }
}

/// Writes the column of mesh nodes for slave nodes that have no state: the mean of several at a mesh node.
pub(super) fn export_of(part: &mut ModelPart, table: &SlaveTable, multiplier: Multiplier) {
    let Some((name, components)) = multiplier.column() else { return };
    let values: Vec<[f64; 3]> = table.owners.iter().map(|&owner| multiplier.value(&part.slave_nodes, owner)).collect();
    let Some(field) = part.nodes.history.get_mut(name) else { return };
    for (at, node) in table.nodes.iter().enumerate() {
        let first = table.nodes.partition_point(|other| other < node);
        let count = table.nodes[first..].partition_point(|other| other == node);
        let entry = components * *node as usize;
        for c in 0..components {
            let before = if at == first { 0.0 } else { field.levels[0][entry + c] };
            field.levels[0][entry + c] = before + values[at][c] / count as f64;
        }
    }
}

/// Gives slave nodes the entry of their mesh node where somebody has written another one than was shown: several slave nodes at a
/// node take its part along their normals.
pub(super) fn import(part: &mut ModelPart, states: &SlaveStates, multiplier: Multiplier) {
    let Some((name, components)) = multiplier.column() else { return };
    let Some(field) = part.nodes.history.get(name) else { return };
    let given = |node: u32| -> [f64; 3] {
        let at = components * node as usize;
        std::array::from_fn(|c| if c < components { field.levels[0][at + c] } else { 0.0 })
    };
    let changed: Vec<(u32, [f64; 3])> = shown(part, states, multiplier)
        .into_iter()
        .map(|(node, shown)| (node, shown, given(node)))
        .filter(|(_, shown, given)| shown != given)
        .map(|(node, _, given)| (node, given))
        .collect();
    for (node, given) in changed {
        let several = states.at(node).nth(1).is_some();
        for slave in states.at(node) {
            let normal = states[slave].normal;
            let along = matches!(multiplier, Multiplier::Vector(_)) && several;
            let own = if along { scale(normal, dot(given, normal)) } else { given };
            multiplier.set(&mut part.slave_nodes, states.owner(slave), own);
        }
    }
}
