//! Contact through a soft layer: the pressure is its stiffness times how far it is pressed in.
//!
//! Active: p = k λ n and b_λ = k (g̃ − A k λ/c): the gap of a node is its pressure over c = STIFFNESS (force per length cubed).
//! Inactive: p = 0 and λ is driven to zero. λ < 0 in compression.

use zelus::contact_structural_mechanics::law::{
    Augmentation, Multiplier, NodeForces, NodeInputs, NodeLaw, SlaveNode, StepParameters,
};
use zelus::contact_structural_mechanics::pairs::Formulation;
use zelus::contact_structural_mechanics::register_contact_formulation;
use zelus::contact_structural_mechanics::variables::LAGRANGE_MULTIPLIER_CONTACT_PRESSURE as PRESSURE;
use zelus_core::scalar::Real;
use zelus_core::vector3::scale;

const STIFFNESS: f64 = 500.0;

struct SoftLayer {
    scale_factor: f64,
}

impl NodeLaw for SoftLayer {
    const MULTIPLIER: Multiplier = Multiplier::Scalar(&PRESSURE);

    fn new(parameters: &StepParameters) -> Self {
        Self { scale_factor: parameters.scale_factor }
    }

    fn evaluate<T: Real>(&self, node: &SlaveNode, inputs: &NodeInputs<T>) -> NodeForces<T> {
        let (k, lambda, zero) = (self.scale_factor, inputs.multiplier[0], T::zero());
        if !node.state.is_active() {
            let row = lambda * (-k * k * Augmentation::Node.softness(node));
            return NodeForces { force: None, multiplier: [row, zero, zero] };
        }
        let row = (inputs.gap - inputs.area * lambda * k / STIFFNESS) * k;
        NodeForces { force: Some(scale(inputs.normal, lambda * k)), multiplier: [row, zero, zero] }
    }
}

register_contact_formulation! { "ALMContactSoftLayer",
    about: "frictionless contact through a soft layer",
    source: "p = c g",
    conditions: ["SoftLayerMortarContactCondition", "SoftLayerAxisymMortarContactCondition"],
    build: Formulation::of::<SoftLayer>(
        "SoftLayerMortarContactCondition",
        &[("NORMAL", 3), ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", 1), ("WEIGHTED_GAP", 1)],
    ),
}
