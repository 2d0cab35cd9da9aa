//! Patches of slave facets, and the slave nodes they own.
//!
//! Slave facets that meet at less than a feature angle share a patch, also where a deck names them as several pairs: two
//! multipliers of one direction at one node would be a null mode. A patch ends at the edges of a body. A mesh node has one
//! *slave node* for each patch that it belongs to, with a normal, a multiplier and a state of its own, so that a corner which
//! is pressed into a corner carries two pressures along two normals. Patches are made of the initial configuration and kept for
//! the run.

use std::collections::BTreeMap;
use std::ops::Range;

use rustc_hash::{FxHashMap, FxHashSet};
use zelus_core::Components;
use zelus_core::geometry::Shape;
use zelus_core::geometry::mapping::unit_normal;
use zelus_core::model::ModelPart;
use zelus_core::vector3::{dot, scale, sub};

use super::facet::{Facet, Roles};
use super::facets::Interface;
use super::slave_index::SlaveIndex;

/// Angle between the normals of two facets, in degrees, from which on their common edge is one of the body. An octagon that
/// stands for a circle turns by 45° a facet and is one surface, a cube turns by 90°.
pub const FEATURE_ANGLE: f64 = 65.0;

/// Places of facets that carry no multipliers.
const NONE: u32 = u32::MAX;

/// A slave node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct PatchNode {
    node: u32,
    patch: u32,
    /// Whether the patch ends here at an edge of its body.
    rim: bool,
}

/// The slave nodes of the interfaces of an interaction.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Patches {
    nodes: Vec<PatchNode>,
    count: usize,
    /// Place of the first slave node of each facet of each interface in `of_facets`; [`NONE`] for masters.
    starts: Vec<Vec<u32>>,
    of_facets: Vec<SlaveIndex>,
    /// Nodes of master facets at edges of bodies, ascending, by interface.
    master_edges: Vec<Vec<u32>>,
}

impl Patches {
    /// The patches of the facets that are slaves or may become slaves. `angle` is the feature angle in degrees; without one all
    /// slave facets at a mesh node share its slave node, as in the reference program.
    pub fn new(part: &ModelPart, interfaces: &[Interface], angle: Option<f64>) -> Self {
        let facets: Vec<(usize, usize)> = interfaces
            .iter()
            .enumerate()
            .flat_map(|(i, interface)| {
                let own = interface.facets.iter().enumerate();
                let may_be_slave = own.filter(|(_, facet)| interface.open || facet.role == Roles::Slave);
                may_be_slave.map(move |(f, _)| (i, f)).collect::<Vec<_>>()
            })
            .collect();
        let facet = |at: usize| &interfaces[facets[at].0].facets[facets[at].1];
        let normals: Vec<[f64; 3]> = (0..facets.len()).map(|at| facet(at).initial_normal(part)).collect();
        let sets = Components::new(facets.len());
        let mut rims: FxHashSet<(u32, u32)> = FxHashSet::default();
        let mut master_edges: Vec<Vec<u32>> = vec![Vec::new(); interfaces.len()];
        match angle {
            None => (1..facets.len()).for_each(|at| sets.join(0, at as u32)),
            Some(angle) => {
                let least = angle.to_radians().cos();
                let mut meeting: BTreeMap<Vec<u32>, Vec<usize>> = BTreeMap::new();
                for at in 0..facets.len() {
                    for edge in edges(facet(at).corners()) {
                        meeting.entry(edge).or_default().push(at);
                    }
                }
                for around in meeting.values() {
                    for (k, &one) in around.iter().enumerate() {
                        let smooth = around[k + 1..].iter().filter(|&&other| dot(normals[one], normals[other]) > least);
                        smooth.for_each(|&other| sets.join(one as u32, other as u32));
                    }
                }
                let sharp = sharp_edges(part, interfaces, least);
                for (edge, around) in meeting.iter().filter(|(edge, _)| sharp.contains(*edge)) {
                    for &at in around {
                        let patch = sets.first(at as u32);
                        rims.extend(nodes_on(facet(at), edge).map(|node| (node, patch)));
                    }
                }
                master_edges = interfaces.iter().map(|own| nodes_of_edges(part, own, &sharp)).collect();
            }
        }
        // Patches are numbered in the order of their first facets.
        let mut numbers: BTreeMap<u32, u32> = BTreeMap::new();
        let patch_of: Vec<(u32, u32)> = (0..facets.len())
            .map(|at| {
                let root = sets.first(at as u32);
                let next = numbers.len() as u32;
                (root, *numbers.entry(root).or_insert(next))
            })
            .collect();
        let mut nodes: Vec<PatchNode> = Vec::new();
        for (at, &(root, patch)) in patch_of.iter().enumerate() {
            nodes.extend(facet(at).nodes.iter().map(|&node| PatchNode {
                node,
                patch,
                rim: rims.contains(&(node, root)),
            }));
        }
        nodes.sort_unstable_by_key(|own| (own.node, own.patch));
        nodes.dedup();
        if part.share.is_some() {
            // A rank that has not all elements at a node sees no edge there.
            let mut rims: Vec<bool> = nodes.iter().map(|own| own.rim).collect();
            part.ranks.any_of(&mut rims);
            nodes.iter_mut().zip(rims).for_each(|(own, rim)| own.rim = rim);
        }
        let mut starts: Vec<Vec<u32>> = interfaces.iter().map(|own| vec![NONE; own.facets.len()]).collect();
        let mut of_facets = Vec::new();
        for (at, &(_, patch)) in patch_of.iter().enumerate() {
            let (i, f) = facets[at];
            starts[i][f] = of_facets.len() as u32;
            of_facets.extend(facet(at).nodes.iter().map(|&node| {
                let place = nodes.binary_search_by_key(&(node, patch), |own| (own.node, own.patch));
                SlaveIndex(place.expect("a node of the patch") as u32)
            }));
        }
        Self { nodes, count: numbers.len(), starts, of_facets, master_edges }
    }

    /// Number of slave nodes.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Number of patches.
    pub fn count(&self) -> usize {
        self.count
    }

    /// All slave nodes.
    pub fn all(&self) -> impl Iterator<Item = SlaveIndex> + use<> {
        (0..self.nodes.len() as u32).map(SlaveIndex)
    }

    /// Mesh node of a slave node.
    pub fn mesh_node(&self, slave: SlaveIndex) -> u32 {
        self.nodes[slave.place()].node
    }

    /// Patch of a slave node.
    pub fn patch(&self, slave: SlaveIndex) -> u32 {
        self.nodes[slave.place()].patch
    }

    /// Whether the patch of a slave node ends there at an edge of its body.
    pub fn is_rim(&self, slave: SlaveIndex) -> bool {
        self.nodes[slave.place()].rim
    }

    /// Nodes of the master facets of an interface at edges of their bodies, ascending.
    pub fn master_edges(&self, interface: usize) -> &[u32] {
        &self.master_edges[interface]
    }

    /// Slave nodes at a mesh node.
    pub fn at(&self, node: u32) -> Range<usize> {
        let first = self.nodes.partition_point(|own| own.node < node);
        first..first + self.nodes[first..].partition_point(|own| own.node == node)
    }

    /// Mesh nodes of a patch, ascending.
    pub fn nodes_of(&self, patch: u32) -> Vec<u32> {
        self.nodes.iter().filter(|own| own.patch == patch).map(|own| own.node).collect()
    }

    /// Slave nodes of a facet in the order of its nodes; none for a master.
    pub fn of_facet(&self, interface: u32, facet: u32, nodes: usize) -> &[SlaveIndex] {
        match self.starts[interface as usize][facet as usize] {
            NONE => &[],
            start => &self.of_facets[start as usize..start as usize + nodes],
        }
    }

    /// Slave nodes of the slave facets of an interface, ascending.
    pub fn slaves_of(&self, interfaces: &[Interface], at: usize) -> Vec<SlaveIndex> {
        let facets = interfaces[at].facets.iter().enumerate().filter(|(_, facet)| facet.role == Roles::Slave);
        let own = facets.flat_map(|(f, facet)| self.of_facet(at as u32, f as u32, facet.nodes.len()));
        let mut out: Vec<SlaveIndex> = own.copied().collect();
        out.sort_unstable();
        out.dedup();
        out
    }

    /// Slave nodes of all slave facets, ascending.
    pub fn slaves(&self, interfaces: &[Interface]) -> Vec<SlaveIndex> {
        let mut out: Vec<SlaveIndex> = (0..interfaces.len()).flat_map(|at| self.slaves_of(interfaces, at)).collect();
        out.sort_unstable();
        out.dedup();
        out
    }
}

/// The edges of bodies (corner nodes, ascending) along interfaces at which two faces meet at more than the feature angle, whose
/// cosine is `least`, and the body is convex.
fn sharp_edges(part: &ModelPart, interfaces: &[Interface], least: f64) -> FxHashSet<Vec<u32>> {
    let mut wanted = vec![false; part.nodes.len()];
    interfaces.iter().flat_map(|own| &own.nodes).for_each(|&node| wanted[node as usize] = true);
    // Outer faces beside the interfaces: their corners, by their sorted nodes; `None` for faces of two elements.
    let mut faces: FxHashMap<Vec<u32>, Option<(Shape, Vec<u32>, u32)>> = FxHashMap::default();
    for element in 0..part.elements.len() as u32 {
        let Some(cell) = part.elements.kinds[element as usize].cell.map(Shape::cell) else { continue };
        let nodes = part.elements.nodes(element);
        if cell.dim != part.info.domain_size || !nodes.iter().any(|&node| wanted[node as usize]) {
            continue;
        }
        for face in cell.faces {
            let own: Vec<u32> = face.nodes.iter().map(|&n| nodes[n]).collect();
            let corners = &own[..face.shape.cell().corners()];
            if corners.iter().filter(|&&node| wanted[node as usize]).count() + 1 < part.info.domain_size {
                continue;
            }
            let mut key = corners.to_vec();
            key.sort_unstable();
            let new = || Some((face.shape, own, element));
            faces.entry(key).and_modify(|face| *face = None).or_insert_with(new);
        }
    }
    let mut around: FxHashMap<Vec<u32>, Vec<([f64; 3], [f64; 3])>> = FxHashMap::default();
    for (shape, nodes, element) in faces.into_values().flatten() {
        if !nodes.iter().all(|&node| part.has_all_at(node as usize)) {
            continue;
        }
        let places: Vec<[f64; 3]> = nodes.iter().map(|&node| part.nodes.initial[node as usize]).collect();
        let Some(normal) = unit_normal(shape, &places, shape.cell().centre) else { continue };
        let centre = mean(&places);
        let body: Vec<[f64; 3]> =
            part.elements.nodes(element).iter().map(|&node| part.nodes.initial[node as usize]).collect();
        let outward = if dot(normal, sub(centre, mean(&body))) < 0.0 { scale(normal, -1.0) } else { normal };
        for edge in edges(&nodes[..shape.cell().corners()]) {
            around.entry(edge).or_default().push((outward, centre));
        }
    }
    let is_sharp = |edge: &[u32], faces: &[([f64; 3], [f64; 3])]| {
        let [(one, _), (other, centre)] = faces else { return false };
        let places: Vec<[f64; 3]> = edge.iter().map(|&node| part.nodes.initial[node as usize]).collect();
        dot(*one, *other) <= least && dot(*one, sub(*centre, mean(&places))) < 0.0
    };
    around.into_iter().filter(|(edge, faces)| is_sharp(edge, faces)).map(|(edge, _)| edge).collect()
}

/// Nodes of a facet on one of its edges: the corners, and of second order the one between them.
fn nodes_on<'a>(facet: &'a Facet, edge: &'a [u32]) -> impl Iterator<Item = u32> + 'a {
    let corners = facet.corners();
    let between = edges(corners).iter().position(|own| own == edge).map(|at| corners.len() + at);
    let between = between.filter(|_| edge.len() == 2).and_then(|at| facet.nodes.get(at));
    edge.iter().chain(between).copied()
}

/// Nodes of the facets of an interface that are or may be masters on these edges, ascending. Collective.
fn nodes_of_edges(part: &ModelPart, interface: &Interface, sharp: &FxHashSet<Vec<u32>>) -> Vec<u32> {
    let mut at_edge = vec![false; interface.nodes.len()];
    for facet in interface.facets.iter().filter(|facet| facet.role != Roles::Slave) {
        for node in edges(facet.corners()).into_iter().filter(|edge| sharp.contains(edge)).flatten() {
            at_edge[interface.nodes.binary_search(&node).expect("a node of the interface")] = true;
        }
    }
    if part.share.is_some() {
        part.ranks.any_of(&mut at_edge);
    }
    interface.nodes.iter().zip(at_edge).filter(|(_, at_edge)| *at_edge).map(|(&node, _)| node).collect()
}

fn mean(places: &[[f64; 3]]) -> [f64; 3] {
    std::array::from_fn(|c| places.iter().map(|x| x[c]).sum::<f64>() / places.len() as f64)
}

/// The edges of a face with these corners, each by its nodes in ascending order: ends of a line, sides of a surface.
pub(super) fn edges(corners: &[u32]) -> Vec<Vec<u32>> {
    let count = corners.len();
    if count == 2 {
        return corners.iter().map(|&node| vec![node]).collect();
    }
    let side = |n: usize| {
        let (a, b) = (corners[n], corners[(n + 1) % count]);
        vec![a.min(b), a.max(b)]
    };
    (0..count).map(side).collect()
}
