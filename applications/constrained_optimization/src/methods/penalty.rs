//! Penalty: ℓ = ε/2 ⟨−g⟩² with Macaulay's bracket (eqs. 4.10, D.1b, D.3c, D.14, D.27), and its adapted form, in which ε follows the
//! penetration (eq. D.4).

use serde::Deserialize;
use zelus_contact_structural_mechanics::adaptation::adapted_penalty;
use zelus_core::processes::ProcessEntry;
use zelus_core::register;
use zelus_core::scalar::Real;

use crate::method::{ConstraintState, Gradient, Method};

/// The penalty method; adapted, the penetration is brought between two bounds.
#[derive(Debug, Clone, Deserialize)]
pub struct Penalty {
    penalty: f64,
    adapt_penalty: bool,
    min_gap: f64,
    max_gap: f64,
}

impl Method for Penalty {
    const MULTIPLIERS: usize = 0;

    fn penalty(&self) -> f64 {
        self.penalty
    }

    fn is_active(&self, state: &ConstraintState) -> bool {
        state.gap < 0.0
    }

    fn gradient<T: Real>(&self, gap: T, _multipliers: [T; 2], state: &ConstraintState) -> Gradient<T> {
        let force = if state.active { gap * state.penalty } else { T::zero() };
        Gradient { gap: force, multipliers: [T::zero(); 2] }
    }

    fn update(&self, state: &mut ConstraintState) {
        if self.adapt_penalty && state.gap < 0.0 {
            state.penalty = adapted_penalty(state.penalty, state.gap, self.min_gap, self.max_gap);
        }
        state.multiplier = state.penalty * state.gap.min(0.0);
    }
}

register! { ProcessEntry "penalty_method_process",
    about: "constraints by the penalty method, on request with an adapted penalty (APM)",
    source: "eqs. D.1, D.4",
    defaults: include_str!("../../../../configs/processes/penalty_method_process.json"),
    build: super::process::<Penalty>,
}
