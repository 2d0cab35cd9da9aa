//! The Hessians of the methods in one gap and their multipliers, against those written out in the specification.

use serde_json::{Value, json};
use zelus_core::scalar::Dual;

use super::{AugmentedLagrangian, DoubleLagrangeMultiplier, LagrangeMultiplier, Penalty, Uzawa};
use crate::method::{ConstraintState, Method};

/// Hessian of ℓ over (g, λ₁, λ₂) of a method with these settings, for a gap −0.25 and a penalty 8.
fn hessian<M: Method + serde::de::DeserializeOwned>(settings: Value, active: bool) -> [[f64; 3]; 3] {
    let method: M = serde_json::from_value(settings).unwrap();
    let state = ConstraintState { active, gap: -0.25, penalty: 8.0, multiplier: -1.0, ..ConstraintState::default() };
    let multipliers = [Dual::<3>::variable(-1.0, 1), Dual::variable(-1.0, 2)];
    let gradient = method.gradient(Dual::variable(state.gap, 0), multipliers, &state);
    [gradient.gap, gradient.multipliers[0], gradient.multipliers[1]].map(|row| row.gradient)
}

#[test]
fn hessians_are_those_of_the_specification() {
    let zero = [[0.0; 3]; 3];
    let penalty =
        json!({"penalty": 8.0, "adapt_penalty": false, "min_gap": 1e-6, "max_gap": 1e-3, "scale_factor": 2.0});
    let of_gap = [[8.0, 0.0, 0.0], [0.0; 3], [0.0; 3]];
    assert_eq!(hessian::<Penalty>(penalty.clone(), true), of_gap);
    assert_eq!(hessian::<Penalty>(penalty.clone(), false), zero);
    assert_eq!(hessian::<Uzawa>(penalty.clone(), true), of_gap);
    assert_eq!(hessian::<Uzawa>(penalty.clone(), false), zero);
    // Eq. D.9, with the scale factor of eq. 4.9; the inactive diagonal has the sign of eq. D.24.
    assert_eq!(hessian::<AugmentedLagrangian>(penalty.clone(), true), [[8.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0; 3]]);
    assert_eq!(hessian::<AugmentedLagrangian>(penalty, false), [[0.0; 3], [0.0, -0.5, 0.0], [0.0; 3]]);
    let multiplier = json!({
        "active_set_strategy": 3, "initial_active_set": "empty", "inactive_multipliers": "held", "coupling": 5.0,
    });
    assert_eq!(hessian::<LagrangeMultiplier>(multiplier.clone(), true), [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0; 3]]);
    assert_eq!(hessian::<LagrangeMultiplier>(multiplier.clone(), false), zero);
    let double = [[0.0, 1.0, 1.0], [1.0, -5.0, 5.0], [1.0, 5.0, -5.0]];
    assert_eq!(hessian::<DoubleLagrangeMultiplier>(multiplier.clone(), true), double);
    assert_eq!(hessian::<DoubleLagrangeMultiplier>(multiplier, false), zero);
}
