//! How far interfaces without contact reach out for the other body.

use std::collections::BTreeSet;

use zelus_core::model::Nodes;

use super::activation;
use crate::interface::Interface;
use crate::slave_states::SlaveStates;

/// How much farther than the nearest node of an open interface others are taken hold of with it, in mesh sizes: the first
/// time that a body is free to move, the second, the third.
const REACHES: [f64; 3] = [0.01, 0.5, f64::INFINITY];

/// What interfaces have taken hold of in a step.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Reach {
    reached: usize,
    open: BTreeSet<usize>,
}

impl Reach {
    /// The slave nodes that take hold next; none where there are no more.
    pub(super) fn next(&mut self, nodes: &Nodes, states: &SlaveStates, interfaces: &[Interface]) -> BTreeSet<u32> {
        let mut near = BTreeSet::new();
        while near.is_empty() && self.reached < REACHES.len() {
            near = activation::nearest(nodes, states, interfaces, REACHES[self.reached], &mut self.open);
            self.reached += 1;
        }
        near
    }
}
