//! Frictionless contact by the penalty method (eqs. D.3b, D.3d), pair by pair as in Kratos: p = f ε g̃ n on active nodes.
//!
//! ε g̃ holds an area: it counts the weighted gap of the pair.

use zelus_core::scalar::Real;
use zelus_core::vector3::scale;

use super::alm_frictionless::AlmFrictionless;
use super::penalty_by_node::PenaltyByNode;
use crate::law::{Multiplier, NodeForces, NodeInputs, NodeLaw, SlaveNode, StepParameters};
use crate::pairs::{ByNode, Formulation};
use crate::register_contact_formulation;

/// Penalty method without friction, of weighted gaps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PenaltyFrictionless;

impl NodeLaw for PenaltyFrictionless {
    const MULTIPLIER: Multiplier = Multiplier::None;

    fn new(_: &StepParameters) -> Self {
        Self
    }

    fn evaluate<T: Real>(&self, node: &SlaveNode, inputs: &NodeInputs<T>) -> NodeForces<T> {
        if !node.state.is_active() {
            return NodeForces::none();
        }
        NodeForces::force(scale(inputs.normal, inputs.gap * (node.penalty * node.dynamic_factor)))
    }
}

/// Pair by pair.
const BY_PAIR: Formulation = Formulation::of::<PenaltyFrictionless>(
    "PenaltyFrictionlessMortarContactCondition",
    &[("NORMAL", 3), ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", 1), ("WEIGHTED_GAP", 1)],
);

/// By node, with a multiplier a node.
static IMPLICIT: Formulation =
    Formulation { regularised: true, ..Formulation::of::<AlmFrictionless>(BY_PAIR.condition, BY_PAIR.variables) };

/// By node, in explicit steps.
static EXPLICIT: Formulation = Formulation::of::<PenaltyByNode>(BY_PAIR.condition, BY_PAIR.variables);

register_contact_formulation! { "PenaltyContactFrictionless",
    about: "frictionless contact, penalty method",
    source: "eq. D.3",
    conditions: ["PenaltyFrictionlessMortarContactCondition", "PenaltyFrictionlessAxisymMortarContactCondition"],
    build: Formulation { by_node: Some(ByNode { implicit: &IMPLICIT, explicit: &EXPLICIT }), ..BY_PAIR },
}
