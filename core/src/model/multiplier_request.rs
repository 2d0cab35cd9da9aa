//! Treatment of multipliers that extensions of a solver ask for.

use serde::{Deserialize, Serialize};

/// Treatment of multipliers by iterative linear solvers, as the extensions of a part's solvers have asked for it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MultiplierRequest {
    /// Whether they are condensed, so that the solver sees the other unknowns alone. It goes before `keep`.
    pub condense: bool,
    /// Whether the solver sees all unknowns at once.
    pub keep: bool,
    /// Whether multipliers that cannot be condensed are an error.
    pub only_condensed: bool,
}

impl MultiplierRequest {
    /// All that either asks for.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            condense: self.condense || other.condense,
            keep: self.keep || other.keep,
            only_condensed: self.only_condensed || other.only_condensed,
        }
    }
}
