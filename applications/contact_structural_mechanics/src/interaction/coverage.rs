//! Slave nodes beside the master: next to nothing of their facets is faced, and that lies at the feet of their neighbours.
//!
//! Where the master ends within a slave facet, the dual functions of the overlap belong to all nodes of the facet, and the
//! gap of the far ones is extended to where no master is. Over a sliver of width w that gap counts over an area of w², against
//! which the bodies are infinitely stiff: multipliers of 1e16 then hold what is no contact. The near nodes close the gap of
//! the sliver on their own.

use zelus_core::geometry::mapping::vector_area;
use zelus_core::geometry::parts;
use zelus_core::model::ModelPart;
use zelus_core::vector3::norm;

use super::nodal_sums::NodalSums;
use crate::interface::{Interface, Roles};
use crate::slave_states::SlaveStates;

/// Says of each slave node that is beside the master that it is isolated: the area that it integrates, as a share of its facets,
/// is less than `least` of the share of a neighbour, half of that where it is in contact.
///
/// `weight` of a node is what lengths and areas count with about an axis of revolution.
pub(super) fn isolate_beside(
    part: &ModelPart,
    states: &mut SlaveStates,
    interfaces: &[Interface],
    least: f64,
    weight: impl Fn(u32) -> f64,
) {
    let slaves = states.slaves();
    let facets = || interfaces.iter().flat_map(|i| &i.facets).filter(|facet| facet.role == Roles::Slave);
    let mut whole = NodalSums::<1>::new(part.nodes.len(), &slaves);
    for facet in facets() {
        let size = norm(vector_area(facet.shape, &facet.positions(part)));
        let mean = facet.nodes.iter().map(|&node| weight(node)).sum::<f64>() / facet.nodes.len() as f64;
        // What the shape function of a node integrates of a weight along a line: on the axis it is not nothing.
        for (local, &node) in facet.nodes.iter().enumerate() {
            whole[node][0] += size / parts(facet.shape, local) * (weight(node) + 2.0 * mean) / 3.0;
        }
    }
    let share = |node: u32| match whole[node] {
        [whole] if whole > 0.0 => states[node].area / whole,
        _ => 0.0,
    };
    let mut best = NodalSums::<1>::new(part.nodes.len(), &slaves);
    for facet in facets() {
        let most = facet.nodes.iter().map(|&node| share(node)).fold(0.0, f64::max);
        facet.nodes.iter().for_each(|&node| best[node][0] = best[node][0].max(most));
    }
    let bound = |node: u32| least * if states[node].active { 0.5 } else { 1.0 };
    let beside: Vec<bool> = slaves.iter().map(|&node| share(node) < bound(node) * best[node][0]).collect();
    slaves.iter().zip(beside).for_each(|(&node, beside)| states[node].isolated |= beside);
}
