//! Numbers of slave nodes that are summed over pairs, and over the ranks that evaluate them.

use std::ops::{Index, IndexMut};

use zelus_core::model::ModelPart;

/// `C` numbers of each of some nodes; zero at first.
pub(super) struct NodalSums<'a, const C: usize> {
    nodes: &'a [u32],
    /// By node index.
    slots: Vec<u32>,
    values: Vec<[f64; C]>,
}

impl<'a, const C: usize> NodalSums<'a, C> {
    /// Of `nodes`, ascending, of a part with `count` nodes.
    pub(super) fn new(count: usize, nodes: &'a [u32]) -> Self {
        let mut slots = vec![u32::MAX; count];
        nodes.iter().enumerate().for_each(|(slot, &node)| slots[node as usize] = slot as u32);
        Self { nodes, slots, values: vec![[0.0; C]; nodes.len()] }
    }

    /// Adds up what each rank has at these nodes, which all of them have. Collective.
    pub(super) fn over_ranks(&mut self, part: &ModelPart) {
        let Some(share) = &part.share else { return };
        let halo = share.halo.only(|node| self.nodes.binary_search(&node).is_ok());
        let first = |node: u32| C as u32 * self.slots[node as usize];
        halo.expand(|node, out| out.extend(first(node)..first(node) + C as u32)).sum(self.values.as_flattened_mut());
    }
}

impl<const C: usize> Index<u32> for NodalSums<'_, C> {
    type Output = [f64; C];

    fn index(&self, node: u32) -> &[f64; C] {
        &self.values[self.slots[node as usize] as usize]
    }
}

impl<const C: usize> IndexMut<u32> for NodalSums<'_, C> {
    fn index_mut(&mut self, node: u32) -> &mut [f64; C] {
        &mut self.values[self.slots[node as usize] as usize]
    }
}
