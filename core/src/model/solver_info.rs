//! Facts about the solver of a part that processes and interactions must know.

use serde::{Deserialize, Serialize};

use super::multiplier_request::MultiplierRequest;

/// Facts about the solver of a model part.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SolverInfo {
    /// Whether steps are explicit.
    pub explicit: bool,
    /// Whether each step is one linear solve without iteration.
    pub linear: bool,
    /// Whether loads on bodies of small displacements follow the motion, as they do on others.
    pub follower_loads: bool,
    /// Whether mesh or settings have errors, so that the part is incomplete: only other errors are looked for.
    pub incomplete: bool,
    /// Whether the load factor is an unknown, as with arc length.
    pub unknown_load_factor: bool,
    /// Whether the condition number of every system is computed.
    pub condition_number: bool,
    /// Treatment of multipliers by iterative linear solvers.
    pub multipliers: MultiplierRequest,
}
