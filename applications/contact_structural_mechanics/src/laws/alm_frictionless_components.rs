//! Frictionless contact by the augmented Lagrangian with a vector multiplier.
//!
//! Active: p = f (k λ + ε̂ g̃ n) and b_λ = k g̃ n − k² (A/c) P λ, which drives the tangential part to zero.
//! Inactive: p = 0 and b_λ = −k² (A/c) λ.

use zelus_core::scalar::Real;

use crate::law::{Augmentation, Multiplier, NodeForces, NodeInputs, NodeLaw, SlaveNode, StepParameters};
use crate::mortar::tangential;
use crate::pairs::Formulation;
use crate::register_contact_formulation;
use crate::variables::VECTOR_LAGRANGE_MULTIPLIER;

/// Augmented Lagrangian, multiplier by components, no friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlmFrictionlessComponents {
    /// Scale factor k of the multipliers: traction = k λ.
    pub scale_factor: f64,
    /// Where the gap augments the force.
    pub augmentation: Augmentation,
}

impl NodeLaw for AlmFrictionlessComponents {
    const MULTIPLIER: Multiplier = Multiplier::Vector(&VECTOR_LAGRANGE_MULTIPLIER);

    fn new(parameters: &StepParameters) -> Self {
        Self { scale_factor: parameters.scale_factor, augmentation: parameters.augmentation }
    }

    fn evaluate<T: Real>(&self, node: &SlaveNode, inputs: &NodeInputs<T>) -> NodeForces<T> {
        let (k, lambda, n) = (self.scale_factor, inputs.multiplier, inputs.normal);
        let release = -k * k * self.augmentation.softness(node);
        if !node.state.is_active() {
            return NodeForces { force: None, multiplier: lambda.map(|x| x * release) };
        }
        let normal = inputs.gap * self.augmentation.penalty(node);
        let sliding = tangential(lambda, n);
        NodeForces {
            force: Some(std::array::from_fn(|c| (lambda[c] * k + n[c] * normal) * node.dynamic_factor)),
            multiplier: std::array::from_fn(|c| n[c] * inputs.gap * k + sliding[c] * release),
        }
    }
}

register_contact_formulation! { "ALMContactFrictionlessComponents",
    about: "frictionless contact, augmented Lagrangian, one multiplier a slave node and direction",
    source: "eqs. 4.9, D.11 by components",
    conditions: [
        "ALMFrictionlessComponentsMortarContactCondition", "ALMFrictionlessComponentsAxisymMortarContactCondition"
    ],
    build: Formulation {
        weighted_gaps: true,
        ..Formulation::of::<AlmFrictionlessComponents>(
            "ALMFrictionlessComponentsMortarContactCondition",
            &[("NORMAL", 3), ("VECTOR_LAGRANGE_MULTIPLIER", 3), ("WEIGHTED_GAP", 1), ("WEIGHTED_VECTOR_RESIDUAL", 3)],
        )
    },
}
