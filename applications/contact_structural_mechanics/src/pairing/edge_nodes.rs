//! Slave nodes at the master's edge: next to nothing of their facets is covered by the master, and that lies at the feet of their
//! neighbours.
//!
//! Where the master ends within a slave facet, the dual functions of the overlap belong to all nodes of the facet, and the gap of the
//! far ones is extended to where no master is. Over a sliver of width w that gap counts over an area of w², against which the bodies
//! are infinitely stiff: multipliers of 1e16 then act where there is no contact. The near nodes close the gap of the sliver on their
//! own.

use zelus_core::geometry::mapping::vector_area;
use zelus_core::geometry::parts;
use zelus_core::model::ModelPart;
use zelus_core::vector3::norm;

use super::pairs_of_interfaces::Pairing;
use crate::interface::{Roles, SlaveIndex};
use crate::slave_nodes::{SlaveStates, SlaveSums};

/// Marks each slave node at the master's edge as isolated: the area that it integrates, as a share of its facets, is less than `least`
/// of the share of a neighbour, half of that where it is in contact.
///
/// `weight` of a node is the factor of lengths and areas about an axis of revolution.
pub(crate) fn isolate_edge_nodes(
    part: &ModelPart,
    states: &mut SlaveStates,
    pairing: &Pairing,
    least: f64,
    weight: impl Fn(u32) -> f64,
) {
    let facets = || {
        pairing.interfaces.iter().enumerate().flat_map(|(i, interface)| {
            let slaves = interface.facets.iter().enumerate().filter(|(_, facet)| facet.role == Roles::Slave);
            slaves.map(move |(f, facet)| (facet, pairing.patches.of_facet(i as u32, f as u32, facet.nodes.len())))
        })
    };
    let mut whole = SlaveSums::<f64>::new(states);
    for (facet, slaves) in facets() {
        let size = norm(vector_area(facet.shape, &facet.positions(part)));
        let mean = facet.nodes.iter().map(|&node| weight(node)).sum::<f64>() / facet.nodes.len() as f64;
        // The shape function of a node integrates this of a weight along a line: on the axis it is not nothing.
        for (local, (&node, &slave)) in facet.nodes.iter().zip(slaves).enumerate() {
            whole[slave] += size / parts(facet.shape, local) * (weight(node) + 2.0 * mean) / 3.0;
        }
    }
    let share = |slave: SlaveIndex| match whole[slave] {
        whole if whole > 0.0 => states[slave].kinematics.area / whole,
        _ => 0.0,
    };
    let mut best = SlaveSums::<f64>::new(states);
    for (_, slaves) in facets() {
        let most = slaves.iter().map(|&slave| share(slave)).fold(0.0, f64::max);
        slaves.iter().for_each(|&slave| best[slave] = best[slave].max(most));
    }
    let bound = |slave: SlaveIndex| least * if states[slave].law.active { 0.5 } else { 1.0 };
    let slaves = states.slaves();
    let at_edge: Vec<bool> = slaves.iter().map(|&slave| share(slave) < bound(slave) * best[slave]).collect();
    slaves.iter().zip(at_edge).for_each(|(&slave, at_edge)| states[slave].kinematics.isolated |= at_edge);
}
