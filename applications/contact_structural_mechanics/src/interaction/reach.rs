//! Contact that a step activates because a body is free to move.

use std::collections::BTreeSet;

use zelus_core::model::Nodes;

use super::activation;
use crate::node_state::SlaveIndex;
use crate::slave_states::SlaveStates;

/// How much farther from the master than the nearest node of an open interface a node may be to be activated with it, in mesh
/// sizes: the first time that a body is free to move, the second, the third.
const REACHES: [f64; 3] = [0.01, 0.5, f64::INFINITY];

/// What a step has activated so.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Reach {
    reached: usize,
    open: BTreeSet<usize>,
}

impl Reach {
    /// The slave nodes to activate next; empty where no more are left.
    ///
    /// `slaves` are the slave nodes of each interface.
    pub(super) fn next(
        &mut self,
        nodes: &Nodes,
        states: &SlaveStates,
        slaves: &[Vec<SlaveIndex>],
    ) -> BTreeSet<SlaveIndex> {
        let mut near = BTreeSet::new();
        while near.is_empty() && self.reached < REACHES.len() {
            near = activation::nearest(nodes, states, slaves, REACHES[self.reached], &mut self.open);
            self.reached += 1;
        }
        near
    }
}
