//! Where the equations of several ranks are in the vectors of this one.

use std::sync::Arc;

use rustc_hash::FxHashMap;
use zelus_linear_algebra::{Layout, Owned};

use crate::assembly::Numbering;
use crate::communication::Ranks;

/// The equations that this rank has, and the nodes of those it owns.
#[derive(Default)]
struct OwnedEquations {
    first: u32,
    numbering: Numbering,
    /// How it counts those of others, by their numbers.
    at: FxHashMap<u32, u32>,
    /// First number, equations, and a bit for each that is a multiplier, of the node of each own equation.
    nodes: Vec<[u32; 3]>,
}

/// Places of equations: those that this rank has as it counts them, then those it meets in rows of others. *Ghosts* are the
/// nodes of others that it has met in rows.
#[derive(Clone, Default)]
pub(super) struct LocalToGlobalMap {
    owned: Arc<OwnedEquations>,
    /// Number of each equation that is not here.
    beyond: Vec<u32>,
    at: FxHashMap<u32, u32>,
    /// Equations of ghosts, by place and number.
    ghosts: Vec<(u32, u32)>,
    is_ghost: FxHashMap<u32, [u32; 3]>,
    /// First number and equations of each ghost with multipliers.
    with_multipliers: Vec<[u32; 2]>,
}

impl LocalToGlobalMap {
    /// The equations of `layout`; no ghosts yet.
    pub(super) fn new(ranks: &Ranks, numbering: &Numbering, layout: &Layout) -> Self {
        let first = numbering.starts[ranks.rank()] as u32;
        let mut nodes: Vec<[u32; 3]> = Vec::with_capacity(numbering.own.len());
        // Equations of a node stand together.
        for of_node in numbering.own.chunk_by(|&a, &b| layout.node[a as usize] == layout.node[b as usize]) {
            let bit = |(k, &e): (usize, &u32)| u32::from(layout.multiplier[e as usize]) << k;
            let node = [first + nodes.len() as u32, of_node.len() as u32, of_node.iter().enumerate().map(bit).sum()];
            nodes.extend(of_node.iter().map(|_| node));
        }
        let own = first..first + numbering.own.len() as u32;
        let others = numbering.numbered().filter(|(_, number)| !own.contains(number));
        let at = others.map(|(equation, number)| (number, equation)).collect();
        let owned = OwnedEquations { first, numbering: numbering.clone(), at, nodes };
        Self { owned: Arc::new(owned), ..Self::default() }
    }

    /// Number of all places.
    pub(super) fn len(&self) -> usize {
        self.owned.numbering.numbers.len() + self.beyond.len()
    }

    /// Own equation of a number, where it has one.
    pub(super) fn own(&self, number: u32) -> Option<u32> {
        let at = number.checked_sub(self.owned.first)?;
        self.owned.numbering.own.get(at as usize).copied()
    }

    /// Place of an equation that this rank has or has met, by its number over all ranks.
    pub(super) fn at(&self, number: u32) -> u32 {
        let others = || self.owned.at.get(&number).or_else(|| self.at.get(&number)).copied();
        self.own(number).or_else(others).expect("an equation that this rank has met")
    }

    /// Number over all ranks of the equation at a place, unless it is inactive.
    pub(super) fn number(&self, place: u32) -> Option<u32> {
        let numbering = &self.owned.numbering;
        match (place as usize).checked_sub(numbering.numbers.len()) {
            None => numbering.number(place),
            Some(at) => Some(self.beyond[at]),
        }
    }

    /// Ghosts with multipliers in the order in which the rank met them: first number, and equations.
    pub(super) fn with_multipliers(&self) -> &[[u32; 2]] {
        &self.with_multipliers
    }

    /// Meets the nodes of equations; collective.
    pub(super) fn meet(&mut self, ranks: &Ranks, numbering: &Numbering, numbers: impl Iterator<Item = u32>) {
        let is_new = |number: &u32| self.own(*number).is_none() && !self.is_ghost.contains_key(number);
        let mut new: Vec<u32> = numbers.filter(is_new).collect();
        new.sort_unstable();
        new.dedup();
        let mut wanted = vec![Vec::new(); ranks.size()];
        new.iter().for_each(|&number| wanted[numbering.owner(number)].push(number));
        let node = |&number: &u32| self.owned.nodes[(number - self.owned.first) as usize];
        let asked = ranks.exchange_indices(&wanted);
        let told: Vec<Vec<u32>> = asked.iter().map(|list| list.iter().flat_map(node).collect()).collect();
        for told in ranks.exchange_indices(&told) {
            for &[first, count, bits] in told.as_chunks().0 {
                if self.is_ghost.contains_key(&first) {
                    continue;
                }
                for number in first..first + count {
                    let place = self.owned.at.get(&number).copied().unwrap_or_else(|| {
                        let place = self.len() as u32;
                        self.beyond.push(number);
                        self.at.insert(number, place);
                        place
                    });
                    self.ghosts.push((place, number));
                    self.is_ghost.insert(number, [first, count, bits]);
                }
                if bits != 0 {
                    self.with_multipliers.push([first, count]);
                }
            }
        }
    }

    /// Nodes and kinds of the equations at all places, for those of the equations that are here.
    pub(super) fn layout(&self, owned: &Layout) -> Layout {
        let (mut node, mut multiplier) = (owned.node.clone(), owned.multiplier.clone());
        let mut next = node.iter().max().map_or(0, |&last| last + 1);
        for number in &self.beyond {
            let [first, count, bits] = self.is_ghost[number];
            node.push(next);
            multiplier.push(bits >> (number - first) & 1 == 1);
            next += u32::from(number + 1 == first + count);
        }
        let mut inactive = owned.inactive.clone();
        if !inactive.is_empty() {
            inactive.resize(node.len(), false);
        }
        Layout { node, multiplier, inactive, ..Layout::default() }
    }

    /// Place and owner of each equation of ghosts.
    pub(super) fn ghosts(&self, numbering: &Numbering) -> Vec<(u32, Owned)> {
        let owned = |&(place, number): &(u32, u32)| {
            let owner = numbering.owner(number);
            (place, (owner as u32, number - numbering.starts[owner] as u32))
        };
        self.ghosts.iter().map(owned).collect()
    }
}
