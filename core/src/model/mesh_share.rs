//! Share of this rank in a distributed mesh.

use serde::{Deserialize, Serialize};

use super::halo::Halo;

/// Numbers of the whole mesh.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MeshSizes {
    /// Nodes.
    pub nodes: usize,
    /// Elements.
    pub elements: usize,
    /// Conditions.
    pub conditions: usize,
}

/// Share of this rank in the mesh; indices count its own entities, in the order of the whole mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeshShare {
    /// Rank that evaluates each element.
    pub elements: Vec<u32>,
    /// Rank that evaluates each condition.
    pub conditions: Vec<u32>,
    /// Rank that owns each node with its unknowns.
    pub owners: Vec<u32>,
    /// Rank that evaluates the pairs of facets whose last slave node this is: its owner, or who has fewer of them.
    pub pairs: Vec<u32>,
    /// Place of each node in the whole mesh.
    pub places: Vec<u32>,
    /// Whether every rank has the node and all elements at it.
    pub common: Vec<bool>,
    /// Nodes that several ranks have.
    pub halo: Halo,
    /// Sizes of the whole mesh, over all ranks.
    pub whole: MeshSizes,
}

impl MeshShare {
    /// Whether this rank owns a node with its unknowns.
    pub fn owns(&self, node: usize) -> bool {
        self.owners[node] as usize == self.halo.ranks.rank()
    }
}
