//! Copies that ranks have of each other's items, nodes or unknowns, and how values travel between them.

use serde::{Deserialize, Serialize};

use crate::communication::Ranks;

/// Items that this rank owns and others have copies of, and items of others that it has copies of.
///
/// Both sides of a pair of ranks list the same items in the same order.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Halo {
    /// The ranks that exchange values.
    #[serde(skip)]
    pub ranks: Ranks,
    /// Own items that each rank has copies of, and not all ranks have.
    pub copied: Vec<Vec<u32>>,
    /// Items of each rank that are here as copies, and not on all ranks.
    pub copies: Vec<Vec<u32>>,
    /// Items that all ranks have, by their owners.
    pub everywhere: Vec<Vec<u32>>,
}

impl Halo {
    /// Replaces each value by the sum over all ranks that have the item, the same bits on each of them; collective.
    ///
    /// The owner adds the values of the others in their order and passes the sum on.
    pub fn sum(&self, values: &mut [f64]) {
        self.collect(values, 0.0, |own, other| own + other);
        self.spread(values);
    }

    /// Replaces each value by the least over all ranks that have the item; collective.
    pub fn least(&self, values: &mut [f64]) {
        self.collect(values, f64::MAX, f64::min);
        self.spread(values);
    }

    /// Gives all copies the value of the owner; collective.
    pub fn spread(&self, values: &mut [f64]) {
        let sent: Vec<Vec<f64>> = self.copied.iter().map(|list| pick(list, values)).collect();
        for (list, received) in self.copies.iter().zip(self.ranks.exchange_numbers(&sent)) {
            list.iter().zip(received).for_each(|(&at, value)| values[at as usize] = value);
        }
        if self.everywhere.iter().any(|list| !list.is_empty()) {
            let counts: Vec<usize> = self.everywhere.iter().map(Vec::len).collect();
            let all = self.ranks.gather_counted(&pick(&self.everywhere[self.ranks.rank()], values), &counts);
            self.everywhere.iter().flatten().zip(all).for_each(|(&at, value)| values[at as usize] = value);
        }
    }

    /// Hands the values of copies to their owners, who join them to their own; `nothing` changes no value.
    ///
    /// Few ranks have something for an item that all have, so that only those speak.
    fn collect(&self, values: &mut [f64], nothing: f64, join: impl Fn(f64, f64) -> f64) {
        let rank = self.ranks.rank();
        let message = |owner: usize| -> Vec<f64> {
            let mut message = pick(&self.copies[owner], values);
            if owner != rank {
                for (place, &at) in self.everywhere[owner].iter().enumerate() {
                    let value = values[at as usize];
                    if value != nothing {
                        message.extend([place as f64, value]);
                    }
                }
            }
            message
        };
        let sent: Vec<Vec<f64>> = (0..self.copies.len()).map(message).collect();
        for (list, received) in self.copied.iter().zip(self.ranks.exchange_numbers(&sent)) {
            let (of_list, of_all) = received.split_at(list.len());
            let places = of_all.chunks_exact(2).map(|pair| (self.everywhere[rank][pair[0] as usize], pair[1]));
            for (at, value) in list.iter().copied().zip(of_list.iter().copied()).chain(places) {
                values[at as usize] = join(values[at as usize], value);
            }
        }
    }

    /// The same for some of the items only.
    pub fn only(&self, wanted: impl Fn(u32) -> bool) -> Self {
        self.each_list(|list| list.iter().copied().filter(|&item| wanted(item)).collect())
    }

    /// The same with each item replaced by several, as a node by its unknowns.
    pub fn expand(&self, of: impl Fn(u32, &mut Vec<u32>)) -> Self {
        self.each_list(|list| {
            let mut out = Vec::with_capacity(list.len());
            list.iter().for_each(|&item| of(item, &mut out));
            out
        })
    }

    fn each_list(&self, change: impl Fn(&[u32]) -> Vec<u32>) -> Self {
        let change = |lists: &[Vec<u32>]| -> Vec<Vec<u32>> { lists.iter().map(|list| change(list)).collect() };
        Self {
            ranks: self.ranks.clone(),
            copied: change(&self.copied),
            copies: change(&self.copies),
            everywhere: change(&self.everywhere),
        }
    }
}

fn pick(list: &[u32], values: &[f64]) -> Vec<f64> {
    list.iter().map(|&at| values[at as usize]).collect()
}
