//! Frictionless contact by the augmented Lagrangian with a scalar multiplier (eq. 4.9, D.11).
//!
//! Active: p = f (k λ + ε̂ g̃) n and b_λ = k (g̃ − A (k λ − p°)/ε). Inactive: p = 0 and b_λ = −k² (A/c) λ. λ < 0 in compression.
//!
//! 1/ε is zero but for the perturbed Lagrangian, ∫ k λ g − (k λ)²/(2ε), and for penalties by node: over the pairs of a node its
//! pressure k λ is then ε times its gap. p° is zero but for Uzawa's iteration (eq. D.10), which updates it outside, p° ← k λ, until
//! k λ − p° and with it the gap vanish.

use zelus_core::scalar::Real;
use zelus_core::vector3::scale;

use crate::law::{Augmentation, Multiplier, NodeForces, NodeInputs, NodeLaw, SlaveNode, StepParameters};
use crate::pairs::Formulation;
use crate::register_contact_formulation;
use crate::variables::LAGRANGE_MULTIPLIER_CONTACT_PRESSURE;

/// Augmented Lagrangian, normal multiplier.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlmFrictionless {
    /// Scale factor k of the multipliers: pressure = k λ.
    pub scale_factor: f64,
    /// Where the gap augments the force.
    pub augmentation: Augmentation,
}

impl NodeLaw for AlmFrictionless {
    const MULTIPLIER: Multiplier = Multiplier::Scalar(&LAGRANGE_MULTIPLIER_CONTACT_PRESSURE);

    fn new(parameters: &StepParameters) -> Self {
        Self { scale_factor: parameters.scale_factor, augmentation: parameters.augmentation }
    }

    fn evaluate<T: Real>(&self, node: &SlaveNode, inputs: &NodeInputs<T>) -> NodeForces<T> {
        let (k, lambda, zero) = (self.scale_factor, inputs.multiplier[0], T::zero());
        if !node.state.is_active() {
            let row = lambda * (-k * k * self.augmentation.softness(node));
            return NodeForces { force: None, multiplier: [row, zero, zero] };
        }
        let pressure = (lambda * k + inputs.gap * self.augmentation.penalty(node)) * node.dynamic_factor;
        let regularisation = lambda * k - node.uzawa_pressure;
        let row = (inputs.gap - inputs.area * regularisation * node.compliance) * k;
        NodeForces { force: Some(scale(inputs.normal, pressure)), multiplier: [row, zero, zero] }
    }
}

register_contact_formulation! { "ALMContactFrictionless",
    about: "frictionless contact, augmented Lagrangian, one multiplier a slave node along its normal",
    source: "eqs. 4.9, D.11",
    conditions: ["ALMFrictionlessMortarContactCondition", "ALMFrictionlessAxisymMortarContactCondition"],
    build: Formulation {
        weighted_gaps: true,
        ..Formulation::of::<AlmFrictionless>(
            "ALMFrictionlessMortarContactCondition",
            &[("NORMAL", 3), ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", 1), ("WEIGHTED_GAP", 1), ("WEIGHTED_SCALAR_RESIDUAL", 1)],
        )
    },
}
