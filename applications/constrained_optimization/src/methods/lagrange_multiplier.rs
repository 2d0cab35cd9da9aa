//! Lagrange multiplier: ℓ = λ g while the constraint acts (eqs. D.5b, D.15), nothing otherwise (eq. D.5d).
//!
//! Its Hessian has a zero on the diagonal of each multiplier (eq. D.6b).

use serde::Deserialize;
use zelus_core::processes::ProcessEntry;
use zelus_core::register;
use zelus_core::scalar::Real;

use crate::active_set::ActiveSetStrategy;
use crate::method::{ConstraintState, Gradient, Method};

/// Constraints that act before the first solve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum InitialActiveSet {
    /// None.
    Empty,
    /// Constraints that the strategy picks.
    Checked,
}

/// The multiplier of a constraint that does not act.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum InactiveMultipliers {
    /// Keeps its value.
    Held,
    /// Has a row of zeros, as the Hessian of f alone (eq. D.28).
    WithoutEquation,
}

/// The Lagrange multiplier method with an active-set strategy.
#[derive(Debug, Clone, Deserialize)]
pub struct LagrangeMultiplier {
    active_set_strategy: ActiveSetStrategy,
    initial_active_set: InitialActiveSet,
    inactive_multipliers: InactiveMultipliers,
}

impl Method for LagrangeMultiplier {
    const MULTIPLIERS: usize = 1;

    fn may_start_active(&self) -> bool {
        self.initial_active_set == InitialActiveSet::Checked
    }

    fn is_active(&self, state: &ConstraintState) -> bool {
        self.active_set_strategy.is_active(state.gap, state.multiplier, state.round_off)
    }

    fn gradient<T: Real>(&self, gap: T, [multiplier, _]: [T; 2], state: &ConstraintState) -> Gradient<T> {
        if state.active {
            Gradient { gap: multiplier, multipliers: [gap, T::zero()] }
        } else {
            Gradient { gap: T::zero(), multipliers: [T::zero(); 2] }
        }
    }

    fn inactive_diagonal(&self) -> f64 {
        match self.inactive_multipliers {
            InactiveMultipliers::Held => 1.0,
            InactiveMultipliers::WithoutEquation => 0.0,
        }
    }
}

register! { ProcessEntry "lagrange_multiplier_method_process",
    about: "constraints by Lagrange multipliers with active-set strategy 1, 2 or 3",
    source: "eqs. D.5, D.6",
    defaults: include_str!("../../../../configs/processes/lagrange_multiplier_method_process.json"),
    build: super::process::<LagrangeMultiplier>,
}
