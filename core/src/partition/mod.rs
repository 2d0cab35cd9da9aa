//! Ownership in a mesh that several ranks share: elements by METIS, nodes and conditions after them.
//!
//! [`partition`] cuts the mesh: elements that share a face are neighbours in a graph, and so are the elements behind facets that face
//! each other, so that pairs tend to stay on one rank; elements behind slave facets weigh more. Rank 0 computes it for all.
//! [`surfaces`] asks the processes of a deck for the facets' surfaces, and [`PartitionCounts`] the costs of a partition. [`Shares`] gives the
//! share of each rank, with its [`MeshShare`](crate::model::MeshShare), and [`MeshShare::balance_pairs`](crate::model::MeshShare::balance_pairs) shares
//! out pairs anew once they are known.

mod load_balance;
mod common;
mod counts;
mod faces;
mod facets;
mod interfaces;
mod listed_processes;
mod mesh_shares;
#[cfg(test)]
mod tests;

pub use common::common_nodes;
pub use counts::{PRODUCTS, PartitionCounts, RankCounts, Repeats, Traffic};
pub use facets::ContactFacet;
pub use interfaces::{Pairing, Surface, pairings, surfaces, warnings_of_repeated_pairs};
pub use mesh_shares::{Shares, everywhere};

use zelus_linear_algebra::{WeightedGraph, partition_graph};

use self::faces::{faces, outer_and_shared, shape_of};
use self::facets::{contact_facets, facing_pairs};
use crate::diagnostics::{Diagnostic, Error, Result};
use crate::model::ModelPart;

/// A slave facet weighs as much as this many elements, as measured on a block of hexahedra pressed on another.
pub const FACET_WEIGHT: u32 = 4;
/// An edge between facets that face each other counts as this many shared nodes.
const PAIR_WEIGHT: u32 = 16;

/// Owners of everything in a mesh; ranks count from 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Partition {
    /// Number of ranks.
    pub ranks: usize,
    /// Rank that evaluates each element; none without an element.
    pub elements: Vec<u32>,
    /// Rank that evaluates each condition: that of the element behind it, else of its first node.
    pub conditions: Vec<u32>,
    /// Rank that owns each node with its unknowns: one of those with an element there, where there is one.
    pub nodes: Vec<u32>,
    /// Facets of the surfaces that may touch, in the order of surfaces and faces.
    pub facets: Vec<ContactFacet>,
    /// Faces between elements of different ranks.
    pub cut: usize,
}

impl Partition {
    /// Everything on rank 0, for a mesh too small to share.
    pub fn on_one_rank(part: &ModelPart, ranks: usize) -> Self {
        Self {
            ranks,
            elements: vec![0; part.elements.len()],
            conditions: vec![0; part.conditions.len()],
            nodes: vec![0; part.nodes.len()],
            facets: Vec::new(),
            cut: 0,
        }
    }
}

/// Cuts the mesh of `part` for `ranks` ranks; `surfaces` may touch each other.
///
/// The same mesh and surfaces give the same answer on every rank.
///
/// # Errors
/// Input error when there are more ranks than elements or none; [`Error::System`] when METIS refuses.
pub fn partition(part: &ModelPart, surfaces: &[Surface], ranks: usize) -> Result<Partition> {
    let count = part.elements.len();
    if ranks == 0 || ranks > count {
        let fact = format!("{count} elements cannot be shared by {ranks} ranks: each needs one at least");
        return Err(Diagnostic::error("ranks", fact).remedy(format!("use 1 to {count} ranks")).into());
    }
    let (outer, shared) = outer_and_shared(&faces(part));
    let facets = contact_facets(part, &outer, surfaces);
    let elements_of_nodes = elements_of_nodes(part);
    let mut edges = shared.clone();
    edges.extend(hanging(part, &elements_of_nodes));
    edges.extend(constrained(part, &elements_of_nodes));
    edges.extend(
        facing_pairs(&facets)
            .into_iter()
            .map(|(slave, master)| (facets[slave as usize].element, facets[master as usize].element, PAIR_WEIGHT)),
    );
    let elements = partition_graph(&graph(weights(part, &facets), edges), ranks)
        .map_err(|error| Error::System(error.to_string()))?;
    let cut = shared.iter().filter(|&&(a, b, _)| elements[a as usize] != elements[b as usize]).count();
    let nodes = node_owners(part, &elements, &elements_of_nodes, ranks);
    let conditions = condition_owners(part, &elements, &nodes, &elements_of_nodes);
    Ok(Partition { ranks, elements, conditions, nodes, facets, cut })
}

/// Weight of each element: its nodes, and more behind slave facets.
fn weights(part: &ModelPart, facets: &[ContactFacet]) -> Vec<u32> {
    let nodes = |element: u32| part.elements.nodes(element).len() as u32;
    let mut weights: Vec<u32> = (0..part.elements.len() as u32).map(nodes).collect();
    for facet in facets.iter().filter(|facet| facet.slave) {
        weights[facet.element as usize] += FACET_WEIGHT * nodes(facet.element);
    }
    weights
}

/// Lists of lists in flat arrays: the elements at each node.
struct Lists {
    starts: Vec<usize>,
    items: Vec<u32>,
}

impl Lists {
    fn of(&self, at: u32) -> &[u32] {
        &self.items[self.starts[at as usize]..self.starts[at as usize + 1]]
    }
}

/// The elements at each node, ascending.
fn elements_of_nodes(part: &ModelPart) -> Lists {
    let mut starts = vec![0_usize; part.nodes.len() + 1];
    for element in 0..part.elements.len() as u32 {
        part.elements.nodes(element).iter().for_each(|&node| starts[node as usize + 1] += 1);
    }
    for at in 1..starts.len() {
        starts[at] += starts[at - 1];
    }
    let mut next = starts.clone();
    let mut items = vec![0_u32; starts[part.nodes.len()]];
    for element in 0..part.elements.len() as u32 {
        for &node in part.elements.nodes(element) {
            items[next[node as usize]] = element;
            next[node as usize] += 1;
        }
    }
    Lists { starts, items }
}

/// Lines and points hang on the first other element at each of their nodes.
fn hanging(part: &ModelPart, elements_of_nodes: &Lists) -> Vec<(u32, u32, u32)> {
    let lines = (0..part.elements.len() as u32).filter(|&element| shape_of(part, element).cell().dim < 2);
    let near = |element: u32| {
        part.elements.nodes(element).iter().filter_map(move |&node| {
            elements_of_nodes.of(node).iter().find(|&&other| other != element).map(|&other| (element, other, 1))
        })
    };
    lines.flat_map(near).collect()
}

/// Constraints tie the first elements of their nodes.
fn constrained(part: &ModelPart, elements_of_nodes: &Lists) -> Vec<(u32, u32, u32)> {
    let first = |node: u32| elements_of_nodes.of(node).first().copied();
    let pairs = part.constraints.iter().flat_map(|c| c.masters.iter().map(|((master, _), _)| (c.slave.0, *master)));
    pairs.filter_map(|(slave, master)| Some((first(slave)?, first(master)?, 1))).collect()
}

/// The graph with these edges; an edge given several times has the sum of its weights.
fn graph(vertex_weights: Vec<u32>, edges: Vec<(u32, u32, u32)>) -> WeightedGraph {
    let loose = edges.iter().filter(|edge| edge.0 != edge.1);
    let mut both: Vec<(u32, u32, u32)> = loose.flat_map(|&(a, b, w)| [(a, b, w), (b, a, w)]).collect();
    both.sort_unstable();
    let mut graph = WeightedGraph { starts: vec![0; vertex_weights.len() + 1], vertex_weights, ..Default::default() };
    for same in both.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        graph.targets.push(same[0].1);
        graph.edge_weights.push(same.iter().map(|edge| edge.2).sum());
        graph.starts[same[0].0 as usize + 1] += 1;
    }
    for at in 1..graph.starts.len() {
        graph.starts[at] += graph.starts[at - 1];
    }
    graph
}

/// The owner of a node is the rank with an element there that owns fewest nodes so far.
fn node_owners(part: &ModelPart, elements: &[u32], elements_of_nodes: &Lists, ranks: usize) -> Vec<u32> {
    let mut owned = vec![0_usize; ranks];
    let mut owners = vec![0_u32; part.nodes.len()];
    for node in 0..part.nodes.len() as u32 {
        let near = elements_of_nodes.of(node).iter().map(|&element| elements[element as usize]);
        let owner = near.min_by_key(|&rank| (owned[rank as usize], rank)).unwrap_or(0);
        owners[node as usize] = owner;
        owned[owner as usize] += 1;
    }
    owners
}

/// A condition goes with the first element that has all its nodes, else with the owner of its first node.
fn condition_owners(part: &ModelPart, elements: &[u32], nodes: &[u32], elements_of_nodes: &Lists) -> Vec<u32> {
    let owner = |condition: u32| {
        let own = part.conditions.nodes(condition);
        let Some(&first) = own.first() else { return 0 };
        let holds = |element: &&u32| own.iter().all(|node| part.elements.nodes(**element).contains(node));
        let behind = elements_of_nodes.of(first).iter().find(holds);
        behind.map_or(nodes[first as usize], |&element| elements[element as usize])
    };
    (0..part.conditions.len() as u32).map(owner).collect()
}
