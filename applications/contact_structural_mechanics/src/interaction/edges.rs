//! Normals of slave nodes on sharp edges and corners.
//!
//! The mean of the normals of faces that meet at an edge is the normal of none of them: a block that lands on it would be pushed
//! aside without friction. What the node meets has a normal there, and forces without friction act along that one.

use std::collections::BTreeMap;

use zelus_core::geometry::mapping::unit_normal;
use zelus_core::model::ModelPart;
use zelus_core::vector3::{add, dot, norm, scale, sub};
use zelus_structural_mechanics::variables::NORMAL;

use super::pairing::Pairing;
use crate::slave_states::SlaveStates;

/// Cosine of the angle between a facet and the mean normal of its node, beyond which the node is on an edge: 35°.
const SHARP: f64 = 0.82;

/// Gives slave nodes on sharp edges the normal of what they meet, turned round.
pub(super) fn turn_edges(part: &mut ModelPart, states: &mut SlaveStates, pairing: &Pairing) {
    states.for_all(|state| state.normal_of_master = false);
    let met = opposite_normals(part, pairing);
    for (node, sum) in met {
        let size = norm(sum);
        // Masters on all sides have no normal in common.
        if size < 0.1 {
            continue;
        }
        let at = node as usize;
        let normal = scale(sum, 1.0 / size);
        part.nodes.history.values_mut(&NORMAL, 0)[3 * at..3 * at + 3].copy_from_slice(&normal);
        states[node].normal_of_master = true;
    }
}

/// Sums of the normals into the masters that slave nodes on sharp edges overlap, each direction once.
fn opposite_normals(part: &ModelPart, pairing: &Pairing) -> BTreeMap<u32, [f64; 3]> {
    let mut sharp = BTreeMap::new();
    for facet in pairing.interfaces.iter().flat_map(|interface| &interface.facets) {
        let points = facet.positions(part);
        for (local, &node) in facet.nodes.iter().enumerate() {
            let mean = part.nodes.history.get(NORMAL.name()).map_or([0.0; 3], |field| field.vector(0, node as usize));
            let own = unit_normal(facet.shape, &points, facet.shape.cell().points[local]);
            if own.is_some_and(|own| dot(own, mean) < SHARP) {
                sharp.insert(node, Vec::new());
            }
        }
    }
    if sharp.is_empty() {
        return BTreeMap::new();
    }
    for pair in pairing.blocks.iter().flat_map(|block| block.pairs()).filter(|pair| pair.overlapping) {
        let into = scale(pairing.master(pair.key).normal(part), -1.0);
        for node in &pairing.slave(pair.key).nodes {
            let Some(seen) = sharp.get_mut(node) else { continue };
            if !seen.iter().any(|other: &[f64; 3]| norm(sub(into, *other)) < 1e-6) {
                seen.push(into);
            }
        }
    }
    let sums = sharp.into_iter().filter(|(_, seen)| !seen.is_empty());
    sums.map(|(node, seen)| (node, seen.into_iter().fold([0.0; 3], add))).collect()
}
