//! Slave nodes on edges of their bodies: they follow the master along its normal, not along a mean of their own faces.
//!
//! The rule is that of the formulations with multipliers (`pairing/edges.rs`), for one relation a mesh node.

use std::collections::BTreeSet;

use zelus_core::model::ModelPart;

use crate::active_set::SupportedNodes;
use crate::interface::{Interface, Patches};
use crate::slave_nodes::SlaveStates;

/// The edges of slave surfaces.
#[derive(Clone, Default)]
pub(super) struct MpcEdges {
    /// Nodes at which a patch ends at an edge of its body, ascending.
    rims: Vec<u32>,
}

impl MpcEdges {
    /// The edges at which surfaces turn by more than `angle` (degrees); none where nodes have the mean normal of their faces.
    pub(super) fn new(part: &ModelPart, interfaces: &[Interface], angle: Option<f64>) -> Self {
        if angle.is_none() {
            return Self::default();
        }
        let patches = Patches::new(part, interfaces, angle);
        let mut supports = SupportedNodes::default();
        supports.begin_step(part, interfaces);
        let ends = patches.all().filter(|&slave| patches.is_rim(slave)).map(|slave| patches.mesh_node(slave));
        let rims: BTreeSet<u32> = ends.filter(|node| !supports.planes().contains_key(node)).collect();
        Self { rims: rims.into_iter().collect() }
    }

    /// Nodes that may press as an edge, ascending: no facet around them is in contact with all of its nodes, or with one beside the edge.
    pub(super) fn open(&self, interfaces: &[Interface], states: &SlaveStates) -> Vec<u32> {
        if self.rims.is_empty() {
            return Vec::new();
        }
        let is_rim = |node: u32| self.rims.binary_search(&node).is_ok();
        let is_active = |node: u32| states.at(node).any(|slave| states[slave].law.active);
        let mut closed = BTreeSet::new();
        for facet in interfaces.iter().flat_map(|interface| &interface.facets) {
            let inner = facet.nodes.iter().any(|&node| is_active(node) && !is_rim(node));
            if inner || facet.nodes.iter().all(|&node| is_active(node)) {
                closed.extend(facet.nodes.iter().copied());
            }
        }
        self.rims.iter().copied().filter(|node| !closed.contains(node)).collect()
    }
}
