//! The system over the ranks that share it.

use super::Assembler;
use crate::assembly::{Distribution, Numbering};
use crate::communication::Ranks;

impl Assembler {
    /// The ranks that assemble the system together.
    pub fn ranks(&self) -> &Ranks {
        self.parallel.ranks()
    }

    /// Owners of the unknowns; `None` when one rank has them all.
    pub fn distribution(&self) -> Option<&Distribution> {
        self.parallel.distribution()
    }

    /// The equations of all ranks; `None` when one rank has them all.
    pub fn numbering(&self) -> Option<&Numbering> {
        self.parallel.numbering()
    }

    /// The equations of all ranks where the unknowns are taken for equations.
    pub fn whole_numbering(&self) -> Option<&Numbering> {
        self.parallel.whole_numbering()
    }

    /// The solution of all equations of this rank, from those it owns; collective.
    pub fn complete(&self, own: &[f64]) -> Vec<f64> {
        self.parallel.complete(self.equations.map(), own)
    }

    /// Whether an unknown counts here in sums over all ranks.
    pub fn counts(&self, number: usize) -> bool {
        self.parallel.counts(number)
    }

    /// The sum of one number of each rank that has a share of the system; collective.
    pub fn total(&self, own: f64) -> f64 {
        self.parallel.total(own)
    }

    /// Σ a b over the unknowns of all ranks; collective.
    pub fn dot(&self, a: &[f64], b: &[f64]) -> f64 {
        self.parallel.dot(a, b)
    }
}
