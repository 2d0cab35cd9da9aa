//! Pairs of facets shared out among ranks anew, when one rank has many more of them than others.

use crate::model::MeshShare;

/// The fullest rank may have this many times the mean before pairs move.
const IMBALANCE: f64 = 1.25;
/// Pairs above the mean that are not worth moving: a message takes as long.
const LEAST: u32 = 32;

impl MeshShare {
    /// Decides which rank evaluates which pairs, from the last slave node of each pair; gives how many leave its owner.
    ///
    /// Pairs stay with the owner of that node where ranks are balanced. Otherwise those above the mean go, node by node, to the
    /// rank with the fewest. Pairs are counted, not timed: a run repeats to the bit, and every rank decides the same.
    pub fn balance_pairs(&mut self, last_nodes: impl Iterator<Item = u32>) -> usize {
        self.pairs.clone_from(&self.owners);
        let mut count = vec![0_u32; self.owners.len()];
        last_nodes.for_each(|node| count[node as usize] += 1);
        let mut load = vec![0_u32; self.halo.copied.len()];
        count.iter().zip(&self.owners).for_each(|(count, &rank)| load[rank as usize] += count);
        let mean = f64::from(load.iter().sum::<u32>()) / load.len() as f64;
        let target = mean.ceil() as u32;
        let fullest = load.iter().copied().max().unwrap_or(0);
        if f64::from(fullest) <= IMBALANCE * mean || fullest < target + LEAST {
            return 0;
        }
        // A rank that receives pairs here keeps its own.
        let gives: Vec<bool> = load.iter().map(|&pairs| pairs > target).collect();
        let mut moved = 0;
        for node in 0..count.len() {
            let (pairs, from) = (count[node], self.owners[node] as usize);
            let to = (0..load.len()).min_by_key(|&rank| load[rank]).unwrap_or(from);
            if pairs > 0 && gives[from] && load[from] > target && load[to] + pairs < load[from] {
                self.pairs[node] = to as u32;
                load[from] -= pairs;
                load[to] += pairs;
                moved += pairs as usize;
            }
        }
        moved
    }
}
