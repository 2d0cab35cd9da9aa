//! Corners and edges of masters that stick into slave facets, between the slave nodes.

use zelus_core::diagnostics::coordinates;
use zelus_core::geometry::mapping::{local_coordinates, position};
use zelus_core::model::ModelPart;
use zelus_core::vector3::{dot, sub};

use crate::interface::{Facet, Roles};
use crate::pairing::Pairing;
use crate::search::{Bounds, FACING, Tree};
use crate::slave_nodes::SlaveStates;
use crate::variables::NODAL_H;

/// Depth of a corner in a facet with no node in contact, in mesh sizes, that is more than noise of the mesh.
const NOISE: f64 = 1e-3;
/// Depth of a corner in a facet with a node in contact, in mesh sizes, that no mean over facets hides.
const HIDDEN: f64 = 0.05;
/// Cosine of the least angle between the faces at a corner and the facet. Under a face that lies flat on the slave its nodes see
/// all of the gap.
const FLAT: f64 = 0.996;
/// Share of a facet beside its edges in which a corner is left to its neighbours.
const EDGE: f64 = 0.05;

/// Why a converged state cannot be accepted in which an edge of a master is inside a slave facet and the slave nodes around it do
/// not see it: their gaps are means over the facets, and a corner between them presses with far too little force.
///
/// The first such node of the master is named.
pub(crate) fn pierced(part: &ModelPart, pairing: &Pairing, states: &SlaveStates) -> Option<String> {
    for (at, interface) in pairing.interfaces.iter().enumerate() {
        let corners = pairing.patches.master_edges(at);
        if corners.is_empty() {
            continue;
        }
        let of_role = |role: Roles| interface.facets.iter().enumerate().filter(move |(_, facet)| facet.role == role);
        let slaves: Vec<(usize, &Facet)> = of_role(Roles::Slave).collect();
        let tree = Tree::new(slaves.iter().map(|(_, facet)| Bounds::of(&facet.positions(part))).collect());
        for &node in corners {
            let (x, size) = (part.nodes.current[node as usize], part.nodes.values.values(&NODAL_H, 0)[node as usize]);
            let corners = [x.map(|c| c - size), x.map(|c| c + size)];
            for near in tree.meeting(&Bounds::of(&corners)) {
                let (f, slave) = slaves[near as usize];
                let active = pairing.patches.of_facet(at as u32, f as u32, slave.nodes.len());
                let active = active.iter().any(|&slave| states[slave].law.active);
                let least = size * if active { HIDDEN } else { NOISE };
                let Some(depth) = depth(part, slave, x).filter(|depth| *depth > least && *depth < size) else {
                    continue;
                };
                let normal = slave.normal(part);
                let masters = of_role(Roles::Master).filter(|(_, facet)| facet.nodes.contains(&node));
                let facing: Vec<f64> = masters.map(|(_, facet)| -dot(facet.normal(part), normal)).collect();
                if facing.iter().any(|cosine| *cosine > FACING) && facing.iter().all(|cosine| *cosine < FLAT) {
                    return Some(said(part, node, depth, &slave.nodes));
                }
            }
        }
    }
    None
}

/// How deep a place is behind a facet, where its foot is well inside of it.
fn depth(part: &ModelPart, facet: &Facet, x: [f64; 3]) -> Option<f64> {
    let places = facet.positions(part);
    let foot = local_coordinates(facet.shape, &places, x)?;
    let inside = facet.shape.cell().contains(foot.xi, -EDGE);
    inside.then(|| dot(sub(position(facet.shape, &places, foot.xi), x), facet.normal_at(&places)))
}

fn said(part: &ModelPart, node: u32, depth: f64, facet: &[u32]) -> String {
    let place = coordinates(part.nodes.initial[node as usize]);
    let around: Vec<String> = facet.iter().map(|&node| part.nodes.ids[node as usize].to_string()).collect();
    format!(
        "node {} at {place}, at an edge of a master, is {depth:.3e} inside the slave facet of nodes {}, whose gaps do not detect it: name the side with the edge in \"assume_master_slave\", or give the slave a finer mesh",
        part.nodes.ids[node as usize],
        around.join(", ")
    )
}
