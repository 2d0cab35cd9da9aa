//! The place where a gap augments the force of an augmented Lagrangian.

use super::SlaveNode;

/// Where a gap augments the force of an augmented Lagrangian.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Augmentation {
    /// In the decision of the active set only, with the gap of the whole node. In contact that gap is zero, so it adds
    /// nothing to the force: penalties have no part in the converged state.
    #[default]
    Node,
    /// In the force too, pair by pair as in the reference program. The gaps of the pairs of a node add up to zero, but each
    /// acts through operators of its own: a little of the penalty stays in the converged state.
    Pair,
}

impl Augmentation {
    /// The penalty with which the gap of a pair enters the force of a node.
    #[inline]
    pub fn penalty(self, node: &SlaveNode) -> f64 {
        match self {
            Self::Node => 0.0,
            Self::Pair => node.penalty,
        }
    }

    /// A/c with which multipliers are driven to zero; the reference program's 1/ε where pairs augment.
    #[inline]
    pub fn softness(self, node: &SlaveNode) -> f64 {
        match self {
            Self::Node => node.area / node.stiffness,
            Self::Pair => node.penalty.recip(),
        }
    }
}
