//! Frictionless contact by a penalty that stiffens with depth, pair by pair: p = ε g̃ (1 + g²/A) n on active nodes.
//!
//! g = g̃/A is the gap of the pair (length), negative in penetration, and A its area; √A stands for the size of a facet, so
//! that the pressure is twice that of the linear penalty where it is as deep as a facet is long.

use zelus::contact_structural_mechanics::law::{
    Multiplier, NodeForces, NodeInputs, NodeLaw, SlaveNode, StepParameters,
};
use zelus::contact_structural_mechanics::pairs::Formulation;
use zelus::contact_structural_mechanics::register_contact_formulation;
use zelus_core::scalar::Real;
use zelus_core::vector3::scale;

struct HardeningPenalty;

impl NodeLaw for HardeningPenalty {
    const MULTIPLIER: Multiplier = Multiplier::None;

    fn new(_: &StepParameters) -> Self {
        Self
    }

    fn evaluate<T: Real>(&self, node: &SlaveNode, inputs: &NodeInputs<T>) -> NodeForces<T> {
        if !node.state.is_active() {
            return NodeForces::none();
        }
        let depth = inputs.gap / node.area;
        let pressure = inputs.gap * (depth * depth / node.area + 1.0) * (node.penalty * node.dynamic_factor);
        NodeForces::force(scale(inputs.normal, pressure))
    }
}

register_contact_formulation! { "HardeningPenaltyContactFrictionless",
    about: "frictionless contact by a penalty that stiffens with depth",
    source: "a cubic spring",
    conditions: [
        "HardeningPenaltyFrictionlessMortarContactCondition",
        "HardeningPenaltyFrictionlessAxisymMortarContactCondition"
    ],
    build: Formulation::of::<HardeningPenalty>(
        "HardeningPenaltyFrictionlessMortarContactCondition",
        &[("NORMAL", 3), ("WEIGHTED_GAP", 1)],
    ),
}
