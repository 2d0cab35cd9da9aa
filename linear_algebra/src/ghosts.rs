//! Vectors that several ranks share: each has items of its own and copies, *ghosts*, of items of others.

use std::fmt;
use std::sync::Arc;

use crate::vector::{self, Scalar};

/// Communication of the ranks that share a system; every method but the first two is collective.
pub trait Ranks: Send + Sync {
    /// Number of this rank, from 0.
    fn rank(&self) -> usize;

    /// Number of ranks.
    fn size(&self) -> usize;

    /// The numbers of every rank, one after another; each gives as many numbers.
    fn gather(&self, own: &[f64]) -> Vec<f64>;

    /// As [`Ranks::exchange_numbers`], where `counts` says how many come from each rank.
    fn exchange_counted(&self, parts: &[Vec<f64>], counts: &[usize]) -> Vec<Vec<f64>>;

    /// Sends `parts[r]` to rank r; returns the numbers from each rank.
    fn exchange_numbers(&self, parts: &[Vec<f64>]) -> Vec<Vec<f64>>;

    /// Sends `parts[r]` to rank r; returns the indices from each rank.
    fn exchange_indices(&self, parts: &[Vec<u32>]) -> Vec<Vec<u32>>;
}

/// An item of another rank: its owner, and its number among the items there.
pub type Owned = (u32, u32);

/// Places of the items of a vector: own ones, ghosts, and others of which this rank knows nothing.
#[derive(Clone)]
pub struct Ghosts {
    ranks: Option<Arc<dyn Ranks>>,
    /// Places of own items, ascending; empty where they are the first.
    places: Vec<u32>,
    own: usize,
    /// Places of all items.
    all: usize,
    /// Each ghost: its place, and its owner with its number among the items that this one owns.
    owned: Vec<(u32, Owned)>,
    /// Own items that each rank has ghosts of.
    sent: Vec<Vec<u32>>,
    /// Ghosts of items of each rank.
    received: Vec<Vec<u32>>,
}

impl fmt::Debug for Ghosts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} own items, {} ghosts", self.own, self.owned.len())
    }
}

impl Ghosts {
    /// A rank that has all items itself.
    pub fn none(own: usize) -> Self {
        let (places, owned, sent, received) = Default::default();
        Self { ranks: None, places, own, all: own, owned, sent, received }
    }

    /// A rank with `own` items, the first, and ghosts of these after them; collective.
    pub(crate) fn after(ranks: Arc<dyn Ranks>, own: usize, owned: &[Owned]) -> Self {
        let ghosts: Vec<(u32, Owned)> = (own as u32..).zip(owned.iter().copied()).collect();
        let all = own + ghosts.len();
        let mut made = Self::new(ranks, (0..own as u32).collect(), all, ghosts);
        made.places = Vec::new();
        made
    }

    /// A rank with own items at `places`, ascending, among `all`, and these ghosts; collective.
    pub fn new(ranks: Arc<dyn Ranks>, places: Vec<u32>, all: usize, owned: Vec<(u32, Owned)>) -> Self {
        let mut received = vec![Vec::new(); ranks.size()];
        let mut wanted = vec![Vec::new(); ranks.size()];
        for &(place, (owner, item)) in &owned {
            received[owner as usize].push(place);
            wanted[owner as usize].push(item);
        }
        let mut sent = ranks.exchange_indices(&wanted);
        sent.iter_mut().flatten().for_each(|item| *item = places[*item as usize]);
        Self { ranks: Some(ranks), own: places.len(), places, all, owned, sent, received }
    }

    /// Own entries of a vector over all places.
    pub(crate) fn narrow(&self, all: &[f64]) -> Vec<f64> {
        match self.places.is_empty() {
            true => vector::copied(&all[..self.own]),
            false => self.places.iter().map(|&place| all[place as usize]).collect(),
        }
    }

    /// A vector over all places with own entries, and zero elsewhere.
    pub(crate) fn widen(&self, own: &[f64]) -> Vec<f64> {
        let mut all = vector::zeros(self.all);
        match self.places.is_empty() {
            true => vector::copy(own, &mut all[..self.own]),
            false => self.places.iter().zip(own).for_each(|(&place, &value)| all[place as usize] = value),
        }
        all
    }

    /// Mask of places of own items.
    pub(crate) fn is_own(&self) -> Vec<bool> {
        let mut is_own = vec![false; self.all];
        match self.places.is_empty() {
            true => is_own[..self.own].fill(true),
            false => self.places.iter().for_each(|&place| is_own[place as usize] = true),
        }
        is_own
    }

    /// The ranks, where there are several.
    pub(crate) fn ranks(&self) -> Option<&Arc<dyn Ranks>> {
        self.ranks.as_ref()
    }

    /// Number of own items.
    pub fn own(&self) -> usize {
        self.own
    }

    /// Number of all places.
    pub(crate) fn all(&self) -> usize {
        self.all
    }

    /// Each ghost: its place, and its owner with its number there.
    pub(crate) fn owned(&self) -> &[(u32, Owned)] {
        &self.owned
    }

    /// Own items that each rank has ghosts of.
    pub(crate) fn sent(&self) -> &[Vec<u32>] {
        &self.sent
    }

    /// Ghosts of items of each rank.
    pub(crate) fn received(&self) -> &[Vec<u32>] {
        &self.received
    }

    /// Gives ghosts, of `width` entries each, the values of their owners; collective.
    pub(crate) fn spread<T: Scalar>(&self, values: &mut [T], width: usize) {
        let Some(ranks) = &self.ranks else { return };
        let arrived = ranks.exchange_counted(&packed(&self.sent, values, width), &counts(&self.received, width));
        for_each(&self.received, arrived, width, |at, value| values[at] = T::from_f64(value));
    }

    /// Adds the values of ghosts to the items of their owners; collective.
    pub(crate) fn collect(&self, values: &mut [f32], width: usize) {
        let Some(ranks) = &self.ranks else { return };
        let arrived = ranks.exchange_counted(&packed(&self.received, values, width), &counts(&self.sent, width));
        for_each(&self.sent, arrived, width, |at, value| values[at] += value as f32);
    }

    /// The sum of one number of each rank; collective.
    pub(crate) fn total(&self, own: f64) -> f64 {
        self.ranks.as_ref().map_or(own, |ranks| ranks.gather(&[own]).iter().sum())
    }

    /// The largest of one number of each rank; collective.
    pub(crate) fn largest(&self, own: f64) -> f64 {
        self.ranks.as_ref().map_or(own, |ranks| ranks.gather(&[own]).into_iter().fold(own, f64::max))
    }

    /// Whether it is true on any rank; collective.
    pub(crate) fn any(&self, own: bool) -> bool {
        self.largest(f64::from(u8::from(own))) > 0.0
    }

    /// Inner product of vectors of own entries; collective.
    pub(crate) fn dot<T: Scalar>(&self, a: &[T], b: &[T]) -> f64 {
        self.total(vector::dot(a, b))
    }

    /// Takes from `vector` its parts along `basis`, orthonormal vectors of own entries, and gives their sizes; collective.
    ///
    /// All products are those with the vector as it came, so that it is read once, and that they travel together.
    pub(crate) fn orthogonalise<T: Scalar>(&self, basis: &[Vec<T>], vector: &mut [T]) -> Vec<f64> {
        let own = vector::products(basis, vector);
        let sizes = match &self.ranks {
            None => own,
            Some(ranks) => {
                let all = ranks.gather(&own);
                (0..basis.len()).map(|k| all.iter().skip(k).step_by(basis.len()).sum()).collect()
            }
        };
        vector::subtract_combination(basis, &sizes, vector);
        sizes
    }

    /// Euclidean norm of a vector of own entries; collective.
    pub(crate) fn norm<T: Scalar>(&self, a: &[T]) -> f64 {
        let own = vector::norm(a);
        self.ranks.as_ref().map_or(own, |ranks| vector::norm(&ranks.gather(&[own])))
    }
}

/// Entries of each list.
fn counts(lists: &[Vec<u32>], width: usize) -> Vec<usize> {
    lists.iter().map(|list| list.len() * width).collect()
}

fn packed<T: Copy + Into<f64>>(lists: &[Vec<u32>], values: &[T], width: usize) -> Vec<Vec<f64>> {
    let block = |&at: &u32| values[at as usize * width..(at as usize + 1) * width].iter().map(|&value| value.into());
    lists.iter().map(|list| list.iter().flat_map(block).collect()).collect()
}

fn for_each(lists: &[Vec<u32>], arrived: Vec<Vec<f64>>, width: usize, mut each: impl FnMut(usize, f64)) {
    for (list, arrived) in lists.iter().zip(arrived) {
        for (&at, block) in list.iter().zip(arrived.chunks_exact(width)) {
            block.iter().enumerate().for_each(|(k, &value)| each(at as usize * width + k, value));
        }
    }
}
