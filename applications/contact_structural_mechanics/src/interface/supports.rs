//! What supports hold at the nodes of contact surfaces, and which of them lie on planes of symmetry.

use std::collections::BTreeMap;

use zelus_core::model::{ModelPart, NodeUnknown};
use zelus_core::vector3::norm;
use zelus_structural_mechanics::variables::DISPLACEMENT;

use super::facets::Interface;
use super::normals::{NodalNormals, NormalPatches};

/// Which components of a node's displacement are prescribed, directly or by constraints on prescribed unknowns.
pub type Fixed = [bool; 3];

/// What is prescribed at the nodes of interfaces; nodes that are free are left out.
pub fn fixed_components(part: &ModelPart, interfaces: &[Interface]) -> BTreeMap<u32, Fixed> {
    let constraints = part.constraints.iter().filter(|c| c.active).map(|c| (c.slave, &c.masters[..])).collect();
    let dimension = part.info.domain_size;
    let fixed = |&node: &u32| -> (u32, Fixed) {
        (
            node,
            std::array::from_fn(|c| {
                c < dimension && is_fixed(part, &constraints, (node, DISPLACEMENT.component(c as u8)), 0)
            }),
        )
    };
    interfaces.iter().flat_map(|i| &i.nodes).map(fixed).filter(|(_, fixed)| fixed.contains(&true)).collect()
}

/// Constraints by what they eliminate.
type Constraints<'a> = BTreeMap<NodeUnknown, &'a [(NodeUnknown, f64)]>;

fn is_fixed(part: &ModelPart, constraints: &Constraints<'_>, unknown: NodeUnknown, depth: usize) -> bool {
    let (node, variable) = unknown;
    match constraints.get(&unknown) {
        Some(masters) if depth <= constraints.len() => {
            masters.iter().all(|&(master, _)| is_fixed(part, constraints, master, depth + 1))
        }
        _ => part.nodes.is_fixed(variable, node),
    }
}

/// Sine of an angle at which a surface meets a plane at right angles.
const LEVEL: f64 = 1e-6;
/// Tilt of the neighbours' normals over that of a node at the edge beyond which a surface curves towards right angles: 2 on a
/// cylinder, 1 on a plane.
const CURVES: f64 = 1.25;
/// Square of the least part of a normal in a plane of symmetry.
const LEAST_IN_PLANE: f64 = 0.5;

/// The components that normals of nodes at the edge of a surface lack.
///
/// Such a node has facets on one side only; its mirror images would take what tilts its normal out of the plane. Supports are
/// planes of symmetry where the initial surface meets them at right angles, or curves towards it.
pub fn symmetry_planes(
    part: &ModelPart,
    interfaces: &[Interface],
    fixed: &BTreeMap<u32, Fixed>,
) -> BTreeMap<u32, Fixed> {
    let patches = NormalPatches::new(part.nodes.len(), interfaces, NodalNormals::ByFacets);
    let normal = |node: u32| {
        let sum = patches.sum(node, &part.nodes.initial);
        let size = norm(sum);
        sum.map(|x| if size > 0.0 { x / size } else { 0.0 })
    };
    // Of each fixed component: the sum of the neighbours' normals, their number, and how far they lie to both sides.
    let mut around: BTreeMap<u32, [[f64; 4]; 3]> = BTreeMap::new();
    for facet in interfaces.iter().flat_map(|i| &i.facets) {
        for &node in &facet.nodes {
            let Some(own) = fixed.get(&node) else { continue };
            let entry = around.entry(node).or_default();
            for c in (0..3).filter(|&c| own[c]) {
                for &other in facet.nodes.iter().filter(|other| !fixed.get(other).is_some_and(|f| f[c])) {
                    let aside = part.nodes.initial[other as usize][c] - part.nodes.initial[node as usize][c];
                    entry[c][0] += normal(other)[c];
                    entry[c][1] += 1.0;
                    entry[c][2] = entry[c][2].min(aside);
                    entry[c][3] = entry[c][3].max(aside);
                }
            }
        }
    }
    let is_plane = |node: u32, c: usize| {
        let [sum, count, least, most] = around.get(&node).map_or([0.0; 4], |entry| entry[c]);
        let tilt = normal(node)[c];
        let one_sided = least.abs().min(most.abs()) <= LEVEL * least.abs().max(most.abs());
        count > 0.0 && one_sided && (tilt.abs() <= LEVEL || sum / count / tilt > CURVES)
    };
    let in_plane = |node: u32, own: &Fixed| -> f64 {
        let normal = normal(node);
        (0..3).filter(|&c| !own[c]).map(|c| normal[c] * normal[c]).sum()
    };
    let symmetric =
        |node: u32, own: &Fixed| in_plane(node, own) > LEAST_IN_PLANE && (0..3).all(|c| !own[c] || is_plane(node, c));
    fixed.iter().filter(|(node, own)| symmetric(**node, own)).map(|(&node, &own)| (node, own)).collect()
}
