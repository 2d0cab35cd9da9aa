//! Two multipliers a constraint: ℓ = (λ₁ + λ₂) g − α/2 (λ₁ − λ₂)² while it acts.
//!
//! At the solution they share the force, λ₁ = λ₂ = λ/2, whatever the coupling α > 0. No multiplier has a zero on the diagonal: this is
//! the purpose of the method. The matrix stays indefinite, as that of any saddle point.

use serde::Deserialize;
use zelus_core::processes::ProcessEntry;
use zelus_core::register;
use zelus_core::scalar::Real;

use super::lagrange_multiplier::InitialActiveSet;
use crate::active_set::ActiveSetStrategy;
use crate::method::{ConstraintState, Gradient, Method};

/// The method of double Lagrange multipliers with an active-set strategy.
#[derive(Debug, Clone, Deserialize)]
pub struct DoubleLagrangeMultiplier {
    active_set_strategy: ActiveSetStrategy,
    initial_active_set: InitialActiveSet,
    coupling: f64,
}

impl Method for DoubleLagrangeMultiplier {
    const MULTIPLIERS: usize = 2;

    fn may_start_active(&self) -> bool {
        self.initial_active_set == InitialActiveSet::Checked
    }

    fn is_active(&self, state: &ConstraintState) -> bool {
        self.active_set_strategy.is_active(state.gap, state.multiplier, state.round_off)
    }

    fn gradient<T: Real>(&self, gap: T, [first, second]: [T; 2], state: &ConstraintState) -> Gradient<T> {
        if !state.active {
            return Gradient { gap: T::zero(), multipliers: [T::zero(); 2] };
        }
        let apart = (first - second) * self.coupling;
        Gradient { gap: first + second, multipliers: [gap - apart, gap + apart] }
    }
}

register! { ProcessEntry "double_lagrange_multiplier_method_process",
    about: "constraints by two Lagrange multipliers each, so that no diagonal entry is zero",
    source: "the \"Lagrange doubles\" of Castem 2000",
    defaults: include_str!("../../../../configs/processes/double_lagrange_multiplier_method_process.json"),
    build: super::process::<DoubleLagrangeMultiplier>,
}
