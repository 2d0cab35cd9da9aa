//! Owners of unknowns: mesh nodes and slave nodes.

use serde::{Deserialize, Serialize};

use super::variable::ScalarVariable;

/// The owner of an unknown; owners that stand at one mesh node each have unknowns of the same variables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Owner {
    /// A mesh node, by its index.
    Node(u32),
    /// A slave node, by its index in [`SlaveNodes`](super::SlaveNodes).
    Slave(u32),
}

/// The owners of the unknowns of one variable.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DofOwners {
    /// The variable.
    pub variable: ScalarVariable,
    /// Indices of mesh nodes, in any order.
    pub nodes: Vec<u32>,
    /// Indices of slave nodes, in any order.
    pub slaves: Vec<u32>,
}

impl DofOwners {
    /// Mesh nodes alone.
    pub fn of_nodes(variable: ScalarVariable, nodes: Vec<u32>) -> Self {
        Self { variable, nodes, slaves: Vec::new() }
    }

    /// Slave nodes alone.
    pub fn of_slaves(variable: ScalarVariable, slaves: impl IntoIterator<Item = u32>) -> Self {
        Self { variable, nodes: Vec::new(), slaves: slaves.into_iter().collect() }
    }

    /// All owners, mesh nodes first.
    pub fn owners(&self) -> impl Iterator<Item = Owner> + '_ {
        let nodes = self.nodes.iter().map(|&node| Owner::Node(node));
        nodes.chain(self.slaves.iter().map(|&slave| Owner::Slave(slave)))
    }
}
