//! The trait of methods: a term of the functional for each constraint, and when it acts.

use serde::{Deserialize, Serialize};
use zelus_contact_structural_mechanics::adaptation::adapted_augmented_lagrangian;
use zelus_core::model::Variable;
use zelus_core::scalar::Real;

use crate::variables::{CONSTRAINT_MULTIPLIER, SECOND_CONSTRAINT_MULTIPLIER};

/// The unknowns a method can add to a constraint, in this order.
pub const MULTIPLIERS: [&Variable<f64>; 2] = [&CONSTRAINT_MULTIPLIER, &SECOND_CONSTRAINT_MULTIPLIER];

/// State of a constraint between iterates, in the signs of g ≥ 0 and λ ≤ 0.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ConstraintState {
    /// Whether it acts.
    pub active: bool,
    /// Present gap, negative in penetration.
    pub gap: f64,
    /// Gap of the iterate before.
    pub previous_gap: f64,
    /// Present multiplier; the sum where there are two, the one kept by the method where it is no unknown.
    pub multiplier: f64,
    /// Present penalty parameter.
    pub penalty: f64,
    /// Gap that is no more than round-off.
    pub round_off: f64,
}

impl ConstraintState {
    /// The penalty that Algorithm 7 gives a constraint that is closed or was so at the iterate before.
    pub fn adapted_penalty(&self, max_gap: f64) -> f64 {
        if self.gap.min(self.previous_gap) >= 0.0 || self.gap.abs() <= self.round_off {
            return self.penalty;
        }
        adapted_augmented_lagrangian(self.penalty, self.gap, self.previous_gap, max_gap)
    }
}

/// First derivatives of the term of one constraint.
#[derive(Debug, Clone, Copy)]
pub struct Gradient<T> {
    /// ∂ℓ/∂g: the force on the constraint, negative when it presses.
    pub gap: T,
    /// ∂ℓ/∂λ of each multiplier.
    pub multipliers: [T; 2],
}

/// A term ℓ(g, λ) added to f(x) for each constraint g ≥ 0 (λ ≤ 0); the rest of the framework follows from it.
pub trait Method: Send + Sync + 'static {
    /// Multipliers that become unknowns: 0, 1 or 2.
    const MULTIPLIERS: usize;

    /// Penalty parameter at the start of a step.
    fn penalty(&self) -> f64 {
        0.0
    }

    /// Whether a constraint may act before the first solve of a step.
    fn may_start_active(&self) -> bool {
        true
    }

    /// Whether the constraint acts in this state.
    fn is_active(&self, state: &ConstraintState) -> bool;

    /// Derivatives of ℓ; the tangent is taken from them by dual numbers.
    fn gradient<T: Real>(&self, gap: T, multipliers: [T; 2], state: &ConstraintState) -> Gradient<T>;

    /// Changes of penalty and kept multiplier after an iterate; `state.active` still says how it was computed.
    fn update(&self, _state: &mut ConstraintState) {}

    /// Diagonal of a multiplier whose constraint does not act: 1 keeps its value, 0 leaves it without equation.
    fn inactive_diagonal(&self) -> f64 {
        1.0
    }
}
