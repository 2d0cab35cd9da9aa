//! Vectors over all unknowns on several ranks: each adds what its entities give, and all receive the sum.

use crate::communication::world;
use crate::partition::Partition;

use super::dof_table::DofTable;

/// Which rank owns each unknown: that of its node.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Distribution {
    owner: Vec<u32>,
    /// Unknowns of each rank, ascending.
    owned: Vec<Vec<u32>>,
}

impl Distribution {
    /// The owners of `dofs`.
    pub fn new(dofs: &DofTable, partition: &Partition) -> Self {
        let owner: Vec<u32> = dofs.dofs().iter().map(|dof| partition.nodes[dof.node as usize]).collect();
        let mut owned = vec![Vec::new(); partition.ranks];
        owner.iter().enumerate().for_each(|(number, &rank)| owned[rank as usize].push(number as u32));
        Self { owner, owned }
    }

    /// The rank of an unknown.
    pub fn owner(&self, number: usize) -> u32 {
        self.owner[number]
    }

    /// Whether this rank owns an unknown.
    pub fn is_own(&self, number: usize) -> bool {
        self.owner[number] as usize == world().rank()
    }

    /// Replaces what this rank has by the sum over all ranks, the same bits on each of them; collective.
    ///
    /// Contributions go to the owner, who adds them in the order of the ranks and passes the sums on.
    pub fn sum(&self, values: &mut [f64]) {
        let world = world();
        let rank = world.rank();
        // Each message is the numbers of unknowns, then as many values; numbers below 2^32 are exact in floating point.
        let mut numbers = vec![Vec::new(); world.size()];
        let mut parts = vec![Vec::new(); world.size()];
        for (number, (&value, &owner)) in values.iter().zip(&self.owner).enumerate() {
            if value != 0.0 && owner as usize != rank {
                numbers[owner as usize].push(number as f64);
                parts[owner as usize].push(value);
            }
        }
        numbers.iter_mut().zip(&parts).for_each(|(message, part)| message.extend_from_slice(part));
        for message in world.exchange_numbers(&numbers) {
            let (numbers, part) = message.split_at(message.len() / 2);
            numbers.iter().zip(part).for_each(|(&number, value)| values[number as usize] += value);
        }
        let own: Vec<f64> = self.owned[rank].iter().map(|&number| values[number as usize]).collect();
        let counts: Vec<usize> = self.owned.iter().map(Vec::len).collect();
        let sums = world.gather_counted(&own, &counts);
        self.owned.iter().flatten().zip(sums).for_each(|(&number, sum)| values[number as usize] = sum);
    }
}
