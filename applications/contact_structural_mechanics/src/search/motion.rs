//! How nodes and facets have moved since the step began.

use zelus_core::model::ModelPart;
use zelus_core::vector3::{add, dot, norm, sub};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use crate::interface::Facet;

/// Whether the centre of the slave has gone from the front of the master's plane to its back in the step.
pub fn have_crossed(part: &ModelPart, slave: &Facet, master: &Facet) -> bool {
    let height = |position: &dyn Fn(u32) -> [f64; 3]| {
        let positions = |facet: &Facet| -> Vec<[f64; 3]> { facet.nodes.iter().map(|&n| position(n)).collect() };
        let centre = |x: &[[f64; 3]]| std::array::from_fn(|c| x.iter().map(|x| x[c]).sum::<f64>() / x.len() as f64);
        let (slave, master_at) = (positions(slave), positions(master));
        let normal = master.normal_at(&master_at);
        dot(sub(centre(&slave), centre(&master_at)), normal)
    };
    height(&|n| step_start(part, n)) > 0.0 && height(&|n| part.nodes.current[n as usize]) < 0.0
}

/// Where a node was when the step began.
pub fn step_start(part: &ModelPart, node: u32) -> [f64; 3] {
    let initial = part.nodes.initial[node as usize];
    let Some(field) = part.nodes.history.get(DISPLACEMENT.name()) else { return initial };
    add(initial, field.vector(1.min(field.levels.len() - 1), node as usize))
}

/// How far the farthest of `nodes` has moved in the step (length).
pub fn farthest_motion(part: &ModelPart, nodes: &[u32]) -> f64 {
    let motion = |&n: &u32| norm(sub(part.nodes.current[n as usize], step_start(part, n)));
    nodes.iter().map(motion).fold(0.0, f64::max)
}
