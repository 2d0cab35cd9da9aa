//! Planes of symmetry: supports at which contact surfaces end at right angles.

use std::collections::BTreeMap;

use zelus_core::model::ModelPart;
use zelus_core::vector3::{norm, sub};

use super::facets::Interface;
use super::fixed::FixedDirections;
use super::normals::{NodalNormals, NormalPatches};

/// Sine of an angle at which a surface meets a plane at right angles.
const LEVEL: f64 = 1e-6;
/// Tilt of the neighbours' normals over that of a node at the edge beyond which a surface curves towards right angles: 2 on a
/// cylinder, 1 on a plane.
const CURVES: f64 = 1.25;
/// Square of the least part of a normal in a plane of symmetry.
const LEAST_IN_PLANE: f64 = 0.5;

/// The directions that normals of nodes at the edge of a surface lack.
///
/// Such a node has facets on one side only; its mirror images would cancel the tilt of its normal out of the plane. Supports are planes
/// of symmetry where the initial surface meets them at right angles, or curves towards it.
pub fn symmetry_planes(
    part: &ModelPart,
    interfaces: &[Interface],
    fixed: &BTreeMap<u32, FixedDirections>,
) -> BTreeMap<u32, FixedDirections> {
    let patches = NormalPatches::new(part.nodes.len(), interfaces, NodalNormals::ByFacets);
    let normal = |node: u32| {
        let sum = patches.sum(node, &part.nodes.initial);
        let size = norm(sum);
        sum.map(|x| if size > 0.0 { x / size } else { 0.0 })
    };
    // Of each fixed direction: the sum of the neighbours' normals, their number, and how far they lie to both sides.
    let mut around: BTreeMap<u32, [[f64; 4]; 3]> = BTreeMap::new();
    for facet in interfaces.iter().flat_map(|i| &i.facets) {
        for &node in &facet.nodes {
            let Some(own) = fixed.get(&node) else { continue };
            let entry = around.entry(node).or_default();
            for c in (0..3).filter(|&c| own.fixed[c]) {
                let holds = |other: &u32| fixed.get(other).is_some_and(|other| other.holds(own.axes.0[c]));
                for &other in facet.nodes.iter().filter(|other| !holds(other)) {
                    let way = sub(part.nodes.initial[other as usize], part.nodes.initial[node as usize]);
                    let aside = own.axes.component(c, way);
                    entry[c][0] += own.axes.component(c, normal(other));
                    entry[c][1] += 1.0;
                    entry[c][2] = entry[c][2].min(aside);
                    entry[c][3] = entry[c][3].max(aside);
                }
            }
        }
    }
    let is_plane = |node: u32, own: &FixedDirections, c: usize| {
        let [sum, count, least, most] = around.get(&node).map_or([0.0; 4], |entry| entry[c]);
        let tilt = own.axes.component(c, normal(node));
        let one_sided = least.abs().min(most.abs()) <= LEVEL * least.abs().max(most.abs());
        count > 0.0 && one_sided && (tilt.abs() <= LEVEL || sum / count / tilt > CURVES)
    };
    let in_plane = |node: u32, own: &FixedDirections| -> f64 {
        let normal = own.axes.components(normal(node));
        (0..3).filter(|&c| !own.fixed[c]).map(|c| normal[c] * normal[c]).sum()
    };
    let symmetric = |node: u32, own: &FixedDirections| {
        in_plane(node, own) > LEAST_IN_PLANE && (0..3).all(|c| !own.fixed[c] || is_plane(node, own, c))
    };
    fixed.iter().filter(|(node, own)| symmetric(**node, own)).map(|(&node, &own)| (node, own)).collect()
}
