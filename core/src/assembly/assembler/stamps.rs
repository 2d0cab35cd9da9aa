//! Counters by which solvers tell whether graphs and values are those of the last solve.

use serde::{Deserialize, Serialize};

/// Addend of the stamps of graphs where unknowns are taken for equations.
pub(super) const WHOLE: u64 = 1 << 33;

/// Counts of the changes of graphs and values; a saved run holds them.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub(super) struct Stamps {
    /// Graph of the bulk on the equations; 0 before the first step.
    pub bulk_graph: u64,
    /// Values of the bulk.
    pub bulk_values: u64,
    /// Graph of the interactions on the equations.
    pub coupling_graph: u64,
    /// Values of the interactions.
    pub coupling_values: u64,
    /// Calls of [`Assembler::tangents`](super::Assembler::tangents).
    pub tangents: u64,
}

impl Stamps {
    /// Graph and values of the bulk.
    pub fn of_bulk(&self) -> [u64; 2] {
        [self.bulk_graph, self.bulk_values]
    }

    /// Graph and values of the interactions.
    pub fn of_coupling(&self) -> [u64; 2] {
        [self.coupling_graph, self.coupling_values]
    }
}
