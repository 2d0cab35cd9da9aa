//! Order of the facets of open interfaces: those first that are to be slaves.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet, VecDeque};

use zelus_core::geometry::mapping::domain_size;
use zelus_core::model::ModelPart;
use zelus_structural_mechanics::laws::representative_young;

use super::candidates::FacetExtent;
use super::open_sides::OpenSides;
use crate::interface::{Facet, Interface, Roles, SlaveIndex};

/// Ratio up to which sizes, moduli and areas of surfaces count as equal.
const ALIKE: f64 = 1.2;

/// Factor of the size of a surface that was the slave side so far: a surface keeps its side unless the other one is clearly finer.
const KEPT: f64 = 0.8;

/// All facets: first those that meet another body, surface by surface, then the others, along shared nodes.
///
/// Of surfaces of several bodies the one that meets another with a sharp edge comes first, for an edge is not seen by slave nodes that
/// it presses between; then the finer; of those with similar meshes the softer, then the smaller, then that with the largest
/// initial coordinates. Numbers of nodes and facets change no role.
pub(super) fn walk(
    part: &ModelPart,
    interface: &Interface,
    known: &OpenSides<'_>,
    facing: &BTreeMap<u32, Vec<u32>>,
) -> Vec<u32> {
    let body = |facet: u32| known.bodies[interface.facets[facet as usize].nodes[0] as usize];
    let meeting = facing.iter().flat_map(|(&own, others)| others.iter().map(move |&other| [own, other]));
    let meets: BTreeSet<u32> = meeting.filter(|&[own, other]| body(own) != body(other)).flatten().collect();
    let in_space = order_in_space(part, interface);
    let of_several: Vec<u32> = in_space.iter().copied().filter(|facet| meets.contains(facet)).collect();
    let of_several = surfaces(interface, &of_several);
    let mut measures: Vec<Measures> =
        of_several.iter().map(|surface| measures(part, interface, known, surface)).collect();
    for which in 1..4 {
        level(&mut measures, which);
    }
    let mut order: Vec<usize> = (0..of_several.len()).collect();
    // Stable: surfaces that are alike stay in the order of their coordinates.
    order.sort_by(|&a, &b| measures[a].partial_cmp(&measures[b]).unwrap_or(Ordering::Equal));
    let first = order.into_iter().flat_map(|at| of_several[at].iter().copied());
    first.chain(surfaces(interface, &in_space).into_iter().flatten()).collect()
}

/// Measures of a surface, the less the more it is the slave: 0 with a sharp edge and 1 without, size of the cells, Young's modulus, area.
type Measures = [f64; 4];

/// The measures of a surface in its initial state.
fn measures(part: &ModelPart, interface: &Interface, known: &OpenSides<'_>, surface: &[u32]) -> Measures {
    let [mut size, mut modulus, mut area, mut slaves] = [0.0; 4];
    for facet in surface.iter().map(|&facet| &interface.facets[facet as usize]) {
        let young = part.properties.get(&facet.properties).and_then(representative_young).unwrap_or(0.0);
        let own = initial_size(part, facet);
        size += cell_size(facet, own);
        modulus += young * own;
        area += own;
        slaves += f64::from(facet.role == Roles::Slave);
    }
    let count = surface.len() as f64;
    let kept = if slaves > 0.5 * count { KEPT } else { 1.0 };
    let modulus = if area > 0.0 { modulus / area } else { 0.0 };
    [f64::from(!has_edge(interface, known, surface)), kept * size / count, modulus, area]
}

/// Whether facets of a surface meet at a sharp edge: a node there belongs to two of its patches.
fn has_edge(interface: &Interface, known: &OpenSides<'_>, surface: &[u32]) -> bool {
    let sharp = known.patches.master_edges(known.interface as usize);
    let mut patches: BTreeMap<u32, SlaveIndex> = BTreeMap::new();
    let mut of_facet = |facet: u32| {
        let nodes = interface.facets[facet as usize].nodes.iter().zip(known.nodes(interface, facet));
        let mut at_edges = nodes.filter(|(node, _)| sharp.binary_search(node).is_ok());
        at_edges.any(|(&node, &own)| *patches.entry(node).or_insert(own) != own)
    };
    surface.iter().any(|&facet| of_facet(facet))
}

/// Length or area of a facet in the initial configuration.
fn initial_size(part: &ModelPart, facet: &Facet) -> f64 {
    let places: Vec<[f64; 3]> = facet.nodes.iter().map(|&node| part.nodes.initial[node as usize]).collect();
    domain_size(facet.shape, &places)
}

/// Distance of the nodes of a facet of this length or area.
fn cell_size(facet: &Facet, size: f64) -> f64 {
    let between_nodes = if facet.nodes.len() > facet.shape.cell().corners() { 0.5 } else { 1.0 };
    between_nodes * if facet.shape.dim() == 1 { size } else { size.sqrt() }
}

/// Sets measures that are alike to the smallest of them.
fn level(measures: &mut [Measures], which: usize) {
    let mut order: Vec<usize> = (0..measures.len()).collect();
    order.sort_by(|&a, &b| measures[a][which].total_cmp(&measures[b][which]));
    let mut least = f64::NEG_INFINITY;
    for at in order {
        if measures[at][which] > ALIKE * least || least < 0.0 {
            least = measures[at][which];
        }
        measures[at][which] = least;
    }
}

/// Surfaces of these facets, connected over shared nodes, each in the order in which its facets are reached from its first.
fn surfaces(interface: &Interface, facets: &[u32]) -> Vec<Vec<u32>> {
    let nodes = |facet: u32| interface.facets[facet as usize].nodes.iter();
    let mut of_node: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (at, &facet) in facets.iter().enumerate() {
        nodes(facet).for_each(|&node| of_node.entry(node).or_default().push(at));
    }
    let mut seen = vec![false; facets.len()];
    let mut surfaces = Vec::new();
    for start in 0..facets.len() {
        let mut surface = Vec::new();
        let mut queue = VecDeque::from([start]);
        while let Some(at) = queue.pop_front() {
            if std::mem::replace(&mut seen[at], true) {
                continue;
            }
            surface.push(facets[at]);
            let mut next: Vec<usize> = nodes(facets[at]).flat_map(|node| &of_node[node]).copied().collect();
            next.retain(|&at| !seen[at]);
            next.sort_unstable();
            next.dedup();
            queue.extend(next);
        }
        if !surface.is_empty() {
            surfaces.push(surface);
        }
    }
    surfaces
}

/// Facets sorted by their nodes' initial coordinates, the largest first, those on the same points by their normals.
fn order_in_space(part: &ModelPart, interface: &Interface) -> Vec<u32> {
    let descending = |a: &[f64; 3], b: &[f64; 3]| {
        a.iter().zip(b).map(|(a, b)| b.total_cmp(a)).find(|o| o.is_ne()).unwrap_or(Ordering::Equal)
    };
    let keys: Vec<(Vec<[f64; 3]>, [f64; 3])> = interface
        .facets
        .iter()
        .map(|facet| {
            let mut points: Vec<[f64; 3]> = facet.nodes.iter().map(|&n| part.nodes.initial[n as usize]).collect();
            points.sort_unstable_by(descending);
            (points, FacetExtent::of(part, facet).normal)
        })
        .collect();
    let mut order: Vec<u32> = (0..keys.len() as u32).collect();
    order.sort_by(|&a, &b| {
        let (a, b) = (&keys[a as usize], &keys[b as usize]);
        let points = a.0.iter().zip(&b.0).map(|(a, b)| descending(a, b)).find(|o| o.is_ne());
        points.unwrap_or_else(|| a.0.len().cmp(&b.0.len()).then_with(|| descending(&a.1, &b.1)))
    });
    order
}
