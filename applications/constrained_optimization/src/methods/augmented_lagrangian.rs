//! Augmented Lagrangian: ℓ = kλ g + ε/2 g² while λ̄ = kλ + εg ≤ 0, and −(kλ)²/2ε otherwise (eqs. D.8d, 4.9, D.22).
//!
//! Gradient (eqs. D.8e, D.24): λ̄ and k g, otherwise 0 and −k²λ/ε; its derivative is the Hessian (eqs. D.9, D.24).
//! The set follows from λ̄, so no strategy has to be chosen. Adapted (AALM), ε follows the gap by Algorithm 7.

use serde::Deserialize;
use zelus_core::processes::ProcessEntry;
use zelus_core::register;
use zelus_core::scalar::Real;

use crate::method::{ConstraintState, Gradient, Method};

/// The augmented Lagrangian method with positions and multipliers solved together.
#[derive(Debug, Clone, Deserialize)]
pub struct AugmentedLagrangian {
    penalty: f64,
    scale_factor: f64,
    adapt_penalty: bool,
    max_gap: f64,
}

impl Method for AugmentedLagrangian {
    const MULTIPLIERS: usize = 1;

    fn penalty(&self) -> f64 {
        self.penalty
    }

    fn is_active(&self, state: &ConstraintState) -> bool {
        self.scale_factor * state.multiplier + state.penalty * state.gap <= 0.0
    }

    fn gradient<T: Real>(&self, gap: T, [multiplier, _]: [T; 2], state: &ConstraintState) -> Gradient<T> {
        let k = self.scale_factor;
        let [force, row] = if state.active {
            [multiplier * k + gap * state.penalty, gap * k]
        } else {
            [T::zero(), multiplier * (-k * k / state.penalty)]
        };
        Gradient { gap: force, multipliers: [row, T::zero()] }
    }

    fn update(&self, state: &mut ConstraintState) {
        if self.adapt_penalty {
            state.penalty = state.adapted_penalty(self.max_gap);
        }
    }
}

register! { ProcessEntry "augmented_lagrangian_method_process",
    about: "constraints by the augmented Lagrangian, on request with an adapted penalty (AALM)",
    source: "eqs. D.8, D.9, 4.9; Algorithm 7",
    defaults: include_str!("../../../../configs/processes/augmented_lagrangian_method_process.json"),
    build: super::process::<AugmentedLagrangian>,
}
