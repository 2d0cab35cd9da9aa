//! Costs of a partition for each rank, counted on the mesh.
//!
//! Every rank keeps its own elements with their nodes, and all of the interfaces. With d unknowns a node, g ghosts, p copies
//! that neighbours have of own nodes, C nodes that all ranks have, F slave facets of all ranks, about as many as slave nodes,
//! e entries of the node graph in rows of ghosts, P neighbours, N ranks, I Newton iterations a step and K Krylov iterations a
//! solve with S products of the matrix each, a rank sends in a step at most
//!
//! | what | messages | bytes |
//! |---|---|---|
//! | values of own nodes to those who have copies | I P | 8 d p I |
//! | values of the nodes that all have, passed on round a ring | I (N − 1) | 8 d C I |
//! | residual of ghosts to their owners | I P | 8 d g I |
//! | tangent rows of ghosts to their owners | I P | 8 d² e I |
//! | Krylov: values to those who have copies | I K S P | 8 d p I K S |
//! | Krylov: three sums over all ranks | 3 I K ⌈log₂ N⌉ | 24 I K ⌈log₂ N⌉ |
//! | criteria: four sums over all ranks | 4 I ⌈log₂ N⌉ | 64 I ⌈log₂ N⌉ |
//! | interface: nine numbers a slave node, round a ring; two bytes a pair, four pairs a facet | I (N − 1 + ⌈log₂ N⌉) | (72 + 8 ⌈log₂ N⌉) F I |
//!
//! Coarse levels of multigrid are left out.

use rustc_hash::FxHashMap;
use serde::Serialize;

use super::faces::{faces, outer_and_shared};
use super::facets::facing_pairs;
use super::mesh_shares::everywhere;
use super::{Partition, weights};
use crate::model::ModelPart;

/// Products of the matrix in a Krylov iteration with multigrid: its own, a residual, and two smoothing steps on each way.
pub const PRODUCTS: usize = 6;

/// Entities of one rank, and its neighbours.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct RankCounts {
    /// Elements it evaluates.
    pub elements: usize,
    /// Conditions it evaluates.
    pub conditions: usize,
    /// Nodes it owns.
    pub nodes: usize,
    /// Nodes it has in all: those of its elements and those that all ranks have.
    pub held: usize,
    /// Nodes of its elements that others own.
    pub ghosts: usize,
    /// Copies that other ranks have of its nodes.
    pub copies: usize,
    /// Ranks that own its ghosts or have copies of its nodes.
    pub neighbours: usize,
    /// Faces it shares with elements of other ranks.
    pub cut_faces: usize,
    /// Facets of surfaces that may touch.
    pub facets: usize,
    /// Slave facets of this rank whose pairs are evaluated.
    pub slave_facets: usize,
    /// Slave facets whose nearest facing facet is on another rank.
    pub far_pairs: usize,
    /// Entries of the node graph that its elements give in rows of ghosts.
    pub ghost_entries: usize,
    /// Weight of its elements, as the partition balances it.
    pub load: usize,
}

/// Repetitions of exchanges between ranks in a step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Repeats {
    /// Newton iterations a step.
    pub newton: usize,
    /// Krylov iterations a solve.
    pub krylov: usize,
}

impl Default for Repeats {
    fn default() -> Self {
        Self { newton: 5, krylov: 20 }
    }
}

/// Messages and bytes that one rank sends in a step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Traffic {
    /// Messages.
    pub messages: usize,
    /// Bytes.
    pub bytes: usize,
}

/// The counts of all ranks.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PartitionCounts {
    /// By rank.
    pub ranks: Vec<RankCounts>,
    /// Largest load as a multiple of the mean.
    pub imbalance: f64,
    /// Faces between elements of different ranks.
    pub cut: usize,
    /// Entries of the node graph, each node with itself included.
    pub entries: usize,
    /// Unknowns a node: the dimensions of the elements' space.
    pub unknowns_per_node: usize,
    /// Nodes that all ranks have: those of the interfaces and of the elements at them.
    pub common: usize,
}

impl PartitionCounts {
    /// Counts the entities that `partition` gives each rank of the mesh, where all ranks keep the `common` nodes with the elements at
    /// them.
    pub fn new(part: &ModelPart, partition: &Partition, common: &[bool]) -> Self {
        let mut ranks = vec![RankCounts::default(); partition.ranks];
        let at = |element: u32| partition.elements[element as usize] as usize;
        for (element, weight) in weights(part, &partition.facets).into_iter().enumerate() {
            let rank = &mut ranks[partition.elements[element] as usize];
            rank.elements += 1;
            rank.load += weight as usize;
        }
        partition.conditions.iter().for_each(|&rank| ranks[rank as usize].conditions += 1);
        partition.nodes.iter().for_each(|&rank| ranks[rank as usize].nodes += 1);
        let (_, shared) = outer_and_shared(&faces(part));
        for (a, b, _) in shared {
            if at(a) != at(b) {
                ranks[at(a)].cut_faces += 1;
                ranks[at(b)].cut_faces += 1;
            }
        }
        for facet in &partition.facets {
            let rank = &mut ranks[at(facet.element)];
            rank.facets += 1;
            rank.slave_facets += usize::from(facet.slave);
        }
        for (slave, master) in facing_pairs(&partition.facets) {
            let [own, other] = [slave, master].map(|facet| at(partition.facets[facet as usize].element));
            ranks[own].far_pairs += usize::from(own != other);
        }
        let everywhere = everywhere(part, common);
        let entries = meet(part, partition, &everywhere, &mut ranks);
        let loads = ranks.iter().map(|rank| rank.load);
        let mean = loads.clone().sum::<usize>() as f64 / partition.ranks as f64;
        let imbalance = loads.max().unwrap_or(0) as f64 / mean.max(1.0);
        let space = part.elements.kinds.iter().map(|kind| kind.space).max().unwrap_or(3);
        let common = everywhere.iter().filter(|everywhere| **everywhere).count();
        Self { ranks, imbalance, cut: partition.cut, entries, unknowns_per_node: space.max(1), common }
    }

    /// Bytes and messages that a rank sends in a step, by the table at the head of this file.
    pub fn traffic(&self, rank: usize, repeats: Repeats) -> Traffic {
        let own = &self.ranks[rank];
        let (newton, krylov, d) = (repeats.newton, repeats.krylov, self.unknowns_per_node);
        let count = self.ranks.len();
        let levels = count.next_power_of_two().trailing_zeros() as usize;
        let products = krylov * PRODUCTS;
        let facets: usize = self.ranks.iter().map(|rank| rank.slave_facets).sum();
        let neighbours = own.neighbours * (3 + products);
        let rings = (count - 1) * (usize::from(self.common > 0) + usize::from(facets > 0));
        let sums = (3 * krylov + 4 + usize::from(facets > 0)) * levels;
        let values = 8 * d * (own.copies * (1 + products) + own.ghosts + self.common);
        let tangent = 8 * d * d * own.ghost_entries;
        let all = (24 * krylov + 64 + 8 * facets) * levels + 72 * facets;
        Traffic { messages: newton * (neighbours + rings + sums), bytes: newton * (values + tangent + all) }
    }
}

/// Counts nodes held, ghosts, copies, neighbours and ghost rows of every rank; gives the entries of the whole node graph.
fn meet(part: &ModelPart, partition: &Partition, everywhere: &[bool], ranks: &mut [RankCounts]) -> usize {
    let shared = everywhere.iter().filter(|everywhere| **everywhere).count();
    let mut of_rank: Vec<Vec<u32>> = vec![Vec::new(); partition.ranks];
    for (element, &rank) in partition.elements.iter().enumerate() {
        of_rank[rank as usize].push(element as u32);
    }
    let mut neighbour_pairs: FxHashMap<(u32, u32), ()> = FxHashMap::default();
    let mut all: Vec<u64> = Vec::new();
    let mut pairs: Vec<u64> = Vec::new();
    for (rank, elements) in of_rank.iter().enumerate() {
        pairs.clear();
        for &element in elements {
            let nodes = part.elements.nodes(element);
            pairs.extend(nodes.iter().flat_map(|&a| nodes.iter().map(move |&b| u64::from(a) << 32 | u64::from(b))));
        }
        pairs.sort_unstable();
        pairs.dedup();
        let mut last = u64::MAX;
        ranks[rank].held = shared;
        for &pair in &pairs {
            let node = pair >> 32;
            let owner = partition.nodes[node as usize];
            ranks[rank].held += usize::from(node != last && !everywhere[node as usize]);
            if owner as usize != rank {
                ranks[rank].ghost_entries += 1;
                if node != last {
                    ranks[rank].ghosts += 1;
                    ranks[owner as usize].copies += 1;
                    neighbour_pairs.insert((owner.min(rank as u32), owner.max(rank as u32)), ());
                }
            }
            last = node;
        }
        all.extend_from_slice(&pairs);
    }
    for (a, b) in neighbour_pairs.into_keys() {
        ranks[a as usize].neighbours += 1;
        ranks[b as usize].neighbours += 1;
    }
    all.sort_unstable();
    all.dedup();
    all.len()
}
