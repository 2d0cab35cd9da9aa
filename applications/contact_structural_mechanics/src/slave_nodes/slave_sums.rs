//! Sums of numbers of slave nodes over their pairs, and over the ranks that evaluate the pairs.

use std::ops::{Index, IndexMut};

use zelus_core::model::{Halo, ModelPart};

use super::slave_states::SlaveStates;
use crate::interface::SlaveIndex;

/// Numbers of one slave node that are summed; `C` of them.
pub(crate) trait Summands<const C: usize>: Copy + Default {
    /// The numbers, one after the other.
    fn numbers(&self) -> [f64; C];

    /// Sums of the numbers that [`Summands::numbers`] gives.
    fn of(numbers: [f64; C]) -> Self;
}

impl Summands<1> for f64 {
    fn numbers(&self) -> [f64; 1] {
        [*self]
    }

    fn of([number]: [f64; 1]) -> Self {
        number
    }
}

/// Sums of each slave node; zero at first.
pub(crate) struct SlaveSums<T>(Vec<T>);

impl<T: Copy + Default> SlaveSums<T> {
    /// Zero sums of all slave nodes.
    pub(crate) fn new(states: &SlaveStates) -> Self {
        Self(vec![T::default(); states.len()])
    }

    /// Adds up the numbers of all ranks; each has all slave nodes. Collective.
    pub(crate) fn over_ranks<const C: usize>(&mut self, part: &ModelPart, states: &SlaveStates)
    where
        T: Summands<C>,
    {
        self.reduce(part, states, |halo, numbers| halo.sum(numbers));
    }

    /// Takes the least of each number over all ranks. Collective.
    pub(crate) fn least_over_ranks<const C: usize>(&mut self, part: &ModelPart, states: &SlaveStates)
    where
        T: Summands<C>,
    {
        self.reduce(part, states, |halo, numbers| halo.least(numbers));
    }

    fn reduce<const C: usize>(&mut self, part: &ModelPart, states: &SlaveStates, by: impl Fn(Halo, &mut [f64]))
    where
        T: Summands<C>,
    {
        let Some(share) = &part.share else { return };
        let slaves = states.slaves();
        let own = |node: u32| states.at(node).filter(|slave| slaves.binary_search(slave).is_ok());
        let halo = share.halo.only(|node| own(node).next().is_some());
        let places = |slave: SlaveIndex| C as u32 * slave.0..C as u32 * (slave.0 + 1);
        let mut numbers: Vec<[f64; C]> = self.0.iter().map(T::numbers).collect();
        by(halo.expand(|node, out| out.extend(own(node).flat_map(places))), numbers.as_flattened_mut());
        self.0 = numbers.into_iter().map(T::of).collect();
    }
}

impl<T> Index<SlaveIndex> for SlaveSums<T> {
    type Output = T;

    fn index(&self, slave: SlaveIndex) -> &T {
        &self.0[slave.place()]
    }
}

impl<T> IndexMut<SlaveIndex> for SlaveSums<T> {
    fn index_mut(&mut self, slave: SlaveIndex) -> &mut T {
        &mut self.0[slave.place()]
    }
}
