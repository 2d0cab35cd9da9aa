//! The state of a slave node, as decisions give it and residuals take it.

use serde::{Deserialize, Serialize};
use zelus_core::model::flags::{ACTIVE, Flags};
use zelus_core::scalar::Real;

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
    /// It keeps its value while the node sticks: another face of the mesh node is held along it.
    HeldByOtherFace,
}

impl MultiplierConstraint {
    /// Whether both sides stand still along it.
    pub fn is_still(self) -> bool {
        matches!(self, Self::Constant | Self::Crosspoint)
    }
}

/// Orthonormal axes of the supports of a node, one a row; the global axes unless a support acts along another direction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SupportAxes(pub [[f64; 3]; 3]);

impl Default for SupportAxes {
    fn default() -> Self {
        Self([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    }
}

impl SupportAxes {
    /// The components of a vector along them.
    pub fn components<T: Real>(self, vector: [T; 3]) -> [T; 3] {
        if self == Self::default() { vector } else { self.0.map(|axis| along(vector, axis)) }
    }

    /// The component of a vector along one of them.
    pub fn component<T: Real>(self, c: usize, vector: [T; 3]) -> T {
        if self == Self::default() { vector[c] } else { along(vector, self.0[c]) }
    }

    /// The vector with these components along them.
    pub fn vector<T: Real>(self, components: [T; 3]) -> [T; 3] {
        if self == Self::default() {
            return components;
        }
        std::array::from_fn(|d| along(components, [self.0[0][d], self.0[1][d], self.0[2][d]]))
    }
}

fn along<T: Real>(vector: [T; 3], axis: [f64; 3]) -> T {
    vector[0] * axis[0] + vector[1] * axis[1] + vector[2] * axis[2]
}

/// Part of a unit vector that is round-off.
const NO_PART: f64 = 1e-6;

/// Constraints on the components of a multiplier along the axes of its node's supports; of a scalar multiplier the first.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct MultiplierConstraints {
    /// Constraint on each component.
    pub rules: [MultiplierConstraint; 3],
    /// Axes of the components.
    pub axes: SupportAxes,
}

impl MultiplierConstraints {
    /// Whether no component is constrained.
    pub fn are_none(self) -> bool {
        self.rules == [MultiplierConstraint::Free; 3]
    }

    /// Whether both sides stand still along a component.
    pub fn any_still(self) -> bool {
        self.rules.iter().any(|rule| rule.is_still())
    }

    /// Whether the multiplier along component `c` of `axes` is free.
    pub fn is_free_along(self, c: usize, axes: SupportAxes) -> bool {
        if self.axes == axes {
            return self.rules[c] == MultiplierConstraint::Free;
        }
        let mut constrained = (0..3).filter(|&own| self.rules[own] != MultiplierConstraint::Free);
        constrained.all(|own| along(self.axes.0[own], axes.0[c]).abs() < NO_PART)
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
