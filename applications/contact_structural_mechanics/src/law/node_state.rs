//! The state of a slave node, as decisions give it and residuals take it.

use serde::{Deserialize, Serialize};
use zelus_core::model::flags::{ACTIVE, Flags};

use crate::flags::SLIP;

/// Whether a slave node is in contact, and how.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum NodeState {
    /// Not in contact.
    #[default]
    Inactive,
    /// In contact and restrained in the tangential direction.
    Stick,
    /// In contact and sliding; the active state of frictionless contact.
    Slip,
}

impl NodeState {
    /// The state that the flags ACTIVE and SLIP of a node say.
    #[inline]
    pub fn of_flags(flags: &Flags, node: usize) -> Self {
        match (flags.is(ACTIVE, node), flags.is(SLIP, node)) {
            (false, _) => Self::Inactive,
            (true, false) => Self::Stick,
            (true, true) => Self::Slip,
        }
    }

    /// Whether the node is in contact.
    #[inline]
    pub fn is_active(self) -> bool {
        self != Self::Inactive
    }
}

/// Constraint on a component of a multiplier.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum MultiplierConstraint {
    /// It has an equation of its own.
    #[default]
    Free,
    /// It keeps its value.
    Constant,
    /// It is the mean of those of the facet's nodes that are in contact and free.
    Crosspoint,
    /// It keeps its value while the node sticks: supports move the opposite master.
    ConstantInStick,
}

impl MultiplierConstraint {
    /// Whether both sides stand still along it.
    pub fn is_still(self) -> bool {
        matches!(self, Self::Constant | Self::Crosspoint)
    }
}

/// How the direction of sliding of a node of area A rotates with its trial traction q̂ = k P λ + κ c WS/A, τ = q̂/|q̂|.
///
/// Zero where the direction is a sign, as in the plane. It enters the tangent only; without it a body that slides is free
/// across its direction.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct DirectionRotation {
    /// κ b/|q̂|, with the sum b of the bounds that the pairs of the node state: slip across τ, in shares of the slip that stick
    /// would forbid. By the penalty method 1/|q|: rotation by trial traction.
    pub by_slip: f64,
    /// k/|q̂|: traction by multiplier across τ, in shares of the bound.
    pub by_multiplier: f64,
}
