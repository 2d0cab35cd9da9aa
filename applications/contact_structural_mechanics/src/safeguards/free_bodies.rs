//! Contact that a step activates because a body is free to move.

use std::collections::BTreeSet;

use zelus_core::model::Nodes;

use crate::active_set::activation;
use crate::interface::SlaveIndex;
use crate::slave_nodes::SlaveStates;

/// How much farther from the master than the nearest node of an open interface a node may be to be activated with it, in mesh
/// sizes: the first time that a body is free to move, the second, the third.
const REACHES: [f64; 3] = [0.01, 0.5, f64::INFINITY];

/// Activation of the nodes nearest to masters, wider each time that a body is free to move in a step.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct FreeBodies {
    reached: usize,
    open: BTreeSet<usize>,
}

impl FreeBodies {
    /// The slave nodes to activate next; empty where no more are left.
    ///
    /// `slaves` are the slave nodes of each interface.
    pub(crate) fn next(
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
