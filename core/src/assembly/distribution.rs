//! Vectors over the unknowns of several ranks: each has those of its nodes, and sums pass through the owners.

use crate::communication::Ranks;
use crate::model::{Halo, ModelPart};

use super::dof_table::DofTable;

/// Owner rank of each unknown this rank has, that of its node, and the places of the copies.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Distribution {
    owners: Vec<u32>,
    halo: Halo,
    /// Place in the whole mesh of each unknown's node.
    places: Vec<u32>,
}

impl Distribution {
    /// The owners of `dofs`; `None` when this rank has everything.
    pub fn new(dofs: &DofTable, part: &ModelPart) -> Option<Self> {
        let share = part.share.as_ref()?;
        let of_nodes = |list: &[u32]| -> Vec<u32> { dofs.dofs().iter().map(|dof| list[dof.node as usize]).collect() };
        let mut starts = vec![0_u32; part.nodes.len() + 1];
        dofs.dofs().iter().for_each(|dof| starts[dof.node as usize + 1] += 1);
        (1..starts.len()).for_each(|at| starts[at] += starts[at - 1]);
        let halo = share.halo.expand(|node, out| out.extend(starts[node as usize]..starts[node as usize + 1]));
        Some(Self { owners: of_nodes(&share.owners), halo, places: of_nodes(&share.places) })
    }

    /// The ranks that share the unknowns.
    pub fn ranks(&self) -> &Ranks {
        &self.halo.ranks
    }

    /// Whether this rank owns an unknown.
    pub fn is_own(&self, number: usize) -> bool {
        self.owners[number] as usize == self.halo.ranks.rank()
    }

    /// Place in the whole mesh of the node of an unknown.
    pub fn place(&self, number: usize) -> u32 {
        self.places[number]
    }

    /// Replaces the values of this rank by the sum over all ranks, bitwise equal on each of them; collective.
    pub fn sum(&self, values: &mut [f64]) {
        self.halo.sum(values);
    }

    /// Gives all copies the value of the owner; collective.
    pub fn spread(&self, values: &mut [f64]) {
        self.halo.spread(values);
    }
}
