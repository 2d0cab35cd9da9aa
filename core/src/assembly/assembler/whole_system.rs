//! The system where unknowns are taken for equations.

use zelus_linear_algebra::{Csr, System};

/// The system over all unknowns, those that are not free as inactive.
#[derive(Debug, Clone, Copy)]
pub struct WholeSystem<'a> {
    /// The system without follower loads.
    pub system: System<'a>,
    /// The tangents of follower loads, where there are any.
    pub loads: Option<&'a Csr>,
}
