//! Numbers of slave nodes that are summed over pairs, and over the ranks that evaluate them.

use std::ops::{Index, IndexMut};

use zelus_core::model::ModelPart;

use super::slave_states::SlaveStates;
use crate::interface::SlaveIndex;

/// `C` numbers of each slave node; zero at first.
pub(crate) struct SlaveSums<const C: usize>(Vec<[f64; C]>);

impl<const C: usize> SlaveSums<C> {
    /// Of all slave nodes.
    pub(crate) fn new(states: &SlaveStates) -> Self {
        Self(vec![[0.0; C]; states.len()])
    }

    /// Adds up the numbers of all ranks; each has all slave nodes. Collective.
    pub(crate) fn over_ranks(&mut self, part: &ModelPart, states: &SlaveStates) {
        let Some(share) = &part.share else { return };
        let slaves = states.slaves();
        let own = |node: u32| states.at(node).filter(|slave| slaves.binary_search(slave).is_ok());
        let halo = share.halo.only(|node| own(node).next().is_some());
        let places = |slave: SlaveIndex| C as u32 * slave.0..C as u32 * (slave.0 + 1);
        halo.expand(|node, out| out.extend(own(node).flat_map(places))).sum(self.0.as_flattened_mut());
    }
}

impl<const C: usize> Index<SlaveIndex> for SlaveSums<C> {
    type Output = [f64; C];

    fn index(&self, slave: SlaveIndex) -> &[f64; C] {
        &self.0[slave.place()]
    }
}

impl<const C: usize> IndexMut<SlaveIndex> for SlaveSums<C> {
    fn index_mut(&mut self, slave: SlaveIndex) -> &mut [f64; C] {
        &mut self.0[slave.place()]
    }
}
