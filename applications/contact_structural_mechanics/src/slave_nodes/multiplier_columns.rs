//! Columns of multipliers at mesh nodes, beside the multipliers of slave nodes.
//!
//! Unknowns are those of slave nodes. Results show a column of mesh nodes: the multiplier of the only slave node there, or the mean
//! of several by area. A deck or a program may write that column before the run or between steps, and the slave nodes take it up.

use zelus_core::model::ModelPart;
use zelus_core::vector3::{dot, scale};

use super::slave_states::{NodalCombination, SlaveStates, SlaveTable};
use crate::interface::SlaveIndex;
use crate::law::Multiplier;

/// Column of mesh nodes with the multipliers of slave nodes, which count by their areas: node, and the three components of its entry.
fn shown(
    part: &ModelPart,
    table: &SlaveTable,
    area: &dyn Fn(SlaveIndex) -> f64,
    multiplier: Multiplier,
) -> Vec<(u32, [f64; 3])> {
    let value = |place: usize| multiplier.value(&part.slave_nodes, table.owners[place]);
    let mut out: Vec<(u32, [f64; 3])> = Vec::with_capacity(table.nodes.len());
    let mut first = 0;
    for own in table.nodes.chunk_by(|a, b| a == b) {
        let places = first..first + own.len();
        first = places.end;
        let several = places.len() > 1;
        let of = places.clone().map(|place| (value(place), area(SlaveIndex(place as u32))));
        out.push((own[0], if several { NodalCombination::Mean.combined(of) } else { value(places.start) }));
    }
    out
}

/// Writes the column of mesh nodes; slave nodes at one of them count by their areas, all alike where none has one.
pub(crate) fn export(
    part: &mut ModelPart,
    table: &SlaveTable,
    area: &dyn Fn(SlaveIndex) -> f64,
    multiplier: Multiplier,
) {
    let Some((name, components)) = multiplier.column() else { return };
    let shown = shown(part, table, area, multiplier);
    let Some(field) = part.nodes.history.get_mut(name) else { return };
    for (node, value) in shown {
        let at = components * node as usize;
        field.levels[0][at..at + components].copy_from_slice(&value[..components]);
    }
}

/// Gives slave nodes the entry of their mesh node where somebody has written another one than was shown: several slave nodes at a
/// node take its part along their normals.
pub(crate) fn import(part: &mut ModelPart, states: &SlaveStates, multiplier: Multiplier) {
    let Some((name, components)) = multiplier.column() else { return };
    let Some(field) = part.nodes.history.get(name) else { return };
    let given = |node: u32| -> [f64; 3] {
        let at = components * node as usize;
        std::array::from_fn(|c| if c < components { field.levels[0][at + c] } else { 0.0 })
    };
    let changed: Vec<(u32, [f64; 3])> = shown(part, states.table(), &|slave| states[slave].kinematics.area, multiplier)
        .into_iter()
        .map(|(node, shown)| (node, shown, given(node)))
        .filter(|(_, shown, given)| shown != given)
        .map(|(node, _, given)| (node, given))
        .collect();
    for (node, given) in changed {
        let several = states.at(node).nth(1).is_some();
        for slave in states.at(node) {
            let normal = states[slave].kinematics.normal;
            let along = matches!(multiplier, Multiplier::Vector(_)) && several;
            let own = if along { scale(normal, dot(given, normal)) } else { given };
            multiplier.set(&mut part.slave_nodes, states.owner(slave), own);
        }
    }
}
