//! Uzawa: ℓ = λ g + ε/2 g² while λ + εg ≤ 0 with λ kept, then λ ← ⟨λ + εg⟩₋ (eqs. D.10a–c).
//!
//! Only positions are solved for, and the matrix stays positive definite. λ converges linearly: for a spring of stiffness
//! k its error falls by k/(k + ε) an iterate.

use serde::Deserialize;
use zelus_core::processes::ProcessEntry;
use zelus_core::register;
use zelus_core::scalar::Real;

use crate::method::{ConstraintState, Gradient, Method};

/// The augmented Lagrangian method with multipliers updated after each solve.
#[derive(Debug, Clone, Deserialize)]
pub struct Uzawa {
    penalty: f64,
    adapt_penalty: bool,
    max_gap: f64,
}

impl Method for Uzawa {
    const MULTIPLIERS: usize = 0;

    fn penalty(&self) -> f64 {
        self.penalty
    }

    fn is_active(&self, state: &ConstraintState) -> bool {
        state.multiplier + state.penalty * state.gap <= 0.0
    }

    fn gradient<T: Real>(&self, gap: T, _multipliers: [T; 2], state: &ConstraintState) -> Gradient<T> {
        let force = if state.active { gap * state.penalty + state.multiplier } else { T::zero() };
        Gradient { gap: force, multipliers: [T::zero(); 2] }
    }

    /// The positions of an iterate that knew nothing of the constraint say nothing of its force: only one that was
    /// computed with it moves the multiplier.
    fn update(&self, state: &mut ConstraintState) {
        if state.active {
            state.multiplier = (state.multiplier + state.penalty * state.gap).min(0.0);
            if self.adapt_penalty {
                state.penalty = state.adapted_penalty(self.max_gap);
            }
        }
    }
}

register! { ProcessEntry "uzawa_method_process",
    about: "constraints by the augmented Lagrangian with Uzawa's update of the multipliers",
    source: "eqs. D.10a–c",
    defaults: include_str!("../../../../configs/processes/uzawa_method_process.json"),
    build: super::process::<Uzawa>,
}
