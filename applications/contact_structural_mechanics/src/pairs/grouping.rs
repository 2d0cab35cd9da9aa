//! Pairs sorted by the shapes of their facets, which is how they become blocks.

use std::collections::BTreeMap;

use zelus_core::geometry::Shape;
use zelus_core::parallel;

use super::pair::PairKey;
use crate::interface::Interface;

/// Numbers of nodes around pairs are multiples of this.
const PLACES: usize = 2;
/// Pairs that a thread takes at a time, at least.
pub const PAIRS: usize = 64;

/// Pairs of the same shapes (slave, master, whether the master has an apex), and their node indices: master nodes, then slave nodes.
pub type Groups<T> = BTreeMap<(Shape, Shape, bool), (Vec<T>, Vec<u32>)>;

/// Sorts `pairs`, whose facets `key` names, by shapes; `apexes` puts those of exact surfaces among the master nodes.
pub fn group_by_shapes<T>(
    interfaces: &[Interface],
    pairs: impl IntoIterator<Item = T>,
    apexes: bool,
    key: impl Fn(&T) -> PairKey,
) -> Groups<T> {
    let mut groups: Groups<T> = BTreeMap::new();
    for pair in pairs {
        let key = key(&pair);
        let facets = &interfaces[key.interface as usize].facets;
        let (slave, master) = (&facets[key.slave as usize], &facets[key.master as usize]);
        let apex = master.exact.as_ref().filter(|_| apexes).map(|exact| exact.1);
        let (group, nodes) = groups.entry((slave.shape, master.shape, apex.is_some())).or_default();
        nodes.extend(master.nodes.iter().copied().chain(apex));
        nodes.extend(&slave.nodes);
        group.push(pair);
    }
    groups
}

/// Sorts pairs of like shapes by the number of nodes around them, and puts those before the `nodes` of each pair.
///
/// Around a pair are the nodes, beside its own, on which the normals of its slave nodes depend, and those of the slave's element where a
/// law reads its tractions: `around` gives both. Numbers are rounded up to few: a node that fills a place is one of the pair.
pub fn group_by_surroundings<T: Sync>(
    around: &(dyn Fn(&T) -> Vec<u32> + Sync),
    pairs: Vec<T>,
    nodes: &[u32],
) -> BTreeMap<usize, (Vec<T>, Vec<u32>)> {
    let size = nodes.len() / pairs.len().max(1);
    let surroundings = parallel::map(pairs.len(), PAIRS, |at| {
        let own = &nodes[at * size..(at + 1) * size];
        let mut around = around(&pairs[at]);
        around.retain(|node| !own.contains(node));
        around.sort_unstable();
        around.dedup();
        around.resize(around.len().next_multiple_of(PLACES), own[0]);
        around
    });
    let mut groups: BTreeMap<usize, (Vec<T>, Vec<u32>)> = BTreeMap::new();
    for ((pair, own), around) in pairs.into_iter().zip(nodes.chunks_exact(size.max(1))).zip(surroundings) {
        let (group, nodes) = groups.entry(around.len()).or_default();
        nodes.extend(around.iter().chain(own));
        group.push(pair);
    }
    groups
}
