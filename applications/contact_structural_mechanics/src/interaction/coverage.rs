//! Slave nodes beside the master: next to nothing of their facets is faced, and that lies at the feet of their neighbours.
//!
//! Where the master ends within a slave facet, the dual functions of the overlap belong to all nodes of the facet, and the
//! gap of the far ones is extended to where no master is. Over a sliver of width w that gap counts over an area of w², against
//! which the bodies are infinitely stiff: multipliers of 1e16 then hold what is no contact. The near nodes close the gap of
//! the sliver on their own.

use zelus_core::model::ModelPart;
use zelus_core::vector3::{cross, norm, sub};

use crate::interface::{Interface, Roles, positions};

/// Of each slave node whether it is beside the master: `area` that it integrates, as a share of its facets, is less than
/// `least` of the share of a neighbour, half of that where it is in contact (`active`).
///
/// `weight` of a node is what lengths and areas count with about an axis of revolution.
pub(super) fn beside(
    part: &ModelPart,
    interfaces: &[Interface],
    area: &[f64],
    least: f64,
    weight: impl Fn(u32) -> f64,
    active: impl Fn(u32) -> bool,
) -> Vec<bool> {
    let facets = || interfaces.iter().flat_map(|i| &i.facets).filter(|facet| facet.role == Roles::Slave);
    let mut whole = vec![0.0; area.len()];
    for facet in facets() {
        let own = measure(positions(facet, part, &mut [[0.0; 3]; 4])) / facet.nodes.len() as f64;
        let mean = facet.nodes.iter().map(|&node| weight(node)).sum::<f64>() / facet.nodes.len() as f64;
        // What the shape function of a node integrates of a weight along a line: on the axis it is not nothing.
        facet.nodes.iter().for_each(|&node| whole[node as usize] += own * (weight(node) + 2.0 * mean) / 3.0);
    }
    let share = |node: u32| match whole[node as usize] {
        whole if whole > 0.0 => area[node as usize] / whole,
        _ => 0.0,
    };
    let mut best = vec![0.0_f64; area.len()];
    for facet in facets() {
        let most = facet.nodes.iter().map(|&node| share(node)).fold(0.0, f64::max);
        facet.nodes.iter().for_each(|&node| best[node as usize] = best[node as usize].max(most));
    }
    let bound = |node: u32| least * if active(node) { 0.5 } else { 1.0 };
    (0..area.len() as u32).map(|node| share(node) < bound(node) * best[node as usize]).collect()
}

/// Length of a line, area of a surface.
fn measure(x: &[[f64; 3]]) -> f64 {
    match x {
        [a, b] => norm(sub(*b, *a)),
        [a, b, c] => 0.5 * norm(cross(sub(*b, *a), sub(*c, *a))),
        [a, b, c, d] => 0.5 * norm(cross(sub(*c, *a), sub(*d, *b))),
        _ => 0.0,
    }
}
