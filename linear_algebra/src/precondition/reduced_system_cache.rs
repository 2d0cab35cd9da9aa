//! Cache of the reduced system, from one system to the next.

use super::blocks::Blocks;
use super::constrained::Constrained;
use crate::system::{Stamps, System};

/// Cache of the reduced system: that of the last system that needed it.
#[derive(Default)]
pub(crate) struct ReducedSystemCache {
    made: Option<(Blocks, Stamps)>,
    is_forgotten: bool,
}

impl ReducedSystemCache {
    /// Whether a system has the bulk of the last, as far as is known: most rows of the reduced system are then those of before.
    pub(crate) fn has_bulk_of(&self, system: &System<'_>) -> bool {
        !self.is_forgotten && self.made.as_ref().is_some_and(|(_, old)| has_same_bulk(old, &Stamps::of(system)))
    }

    /// Lets nothing depend on whether there was a system before; its rows may be used all the same.
    pub(crate) fn forget(&mut self) {
        self.is_forgotten = true;
    }

    /// The reduced system of a system, made from that of an earlier one as far as both have the same bulk; collective.
    pub(crate) fn up_to_date(&mut self, constrained: &Constrained, system: &System<'_>) -> &Blocks {
        let stamps = Stamps::of(system);
        self.is_forgotten = false;
        let made = match self.made.take() {
            Some((blocks, old)) if old == stamps => blocks,
            earlier => {
                let earlier = earlier.filter(|(_, old)| has_same_bulk(old, &stamps));
                constrained.reduced_blocks(system, earlier.as_ref().map(|(blocks, _)| blocks))
            }
        };
        &self.made.insert((made, stamps)).0
    }
}

fn has_same_bulk(old: &Stamps, new: &Stamps) -> bool {
    [old.bulk_graph, old.bulk_values] == [new.bulk_graph, new.bulk_values]
}
