//! Where nodes are looked for when a search is dynamic.

use zelus_core::model::{ModelPart, Nodes, Variable};
use zelus_structural_mechanics::variables::{ACCELERATION, DISPLACEMENT, VELOCITY};

/// Moves the nodes of a dynamic search to x + Δt/4 (v + v₁) + Δt²/8 a₁, with v₁ and a₁ of the step before; fixed components
/// stay. Gives the positions they had, `None` when nothing is predicted.
pub fn predicted_positions(part: &mut ModelPart, dynamic: bool) -> Option<Vec<[f64; 3]>> {
    if !dynamic || !part.nodes.history.has(VELOCITY.name()) {
        return None;
    }
    let time_step = part.info.delta_time;
    let mut shift: Vec<[f64; 3]> = vec![[0.0; 3]; part.nodes.len()];
    let mut add = |variable: &Variable<[f64; 3]>, level: usize, weight: f64| {
        let Some(column) = part.nodes.history.get(variable.name()).and_then(|f| f.levels.get(level)) else { return };
        for (slot, value) in shift.as_flattened_mut().iter_mut().zip(column.iter()) {
            *slot += weight * value;
        }
    };
    add(&VELOCITY, 0, 0.25 * time_step);
    add(&VELOCITY, 1, 0.25 * time_step);
    add(&ACCELERATION, 1, 0.125 * time_step * time_step);
    let still = part.nodes.current.clone();
    let Nodes { current, fixities, .. } = &mut part.nodes;
    let free = |node: usize, c: usize| !fixities.holds(DISPLACEMENT.component(c as u8), node as u32);
    for (node, (position, shift)) in current.iter_mut().zip(shift).enumerate() {
        (0..3).filter(|&c| free(node, c)).for_each(|c| position[c] += shift[c]);
    }
    Some(still)
}
