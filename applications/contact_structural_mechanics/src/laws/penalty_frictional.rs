//! Friction by the penalty method, pair by pair: an elastic slip that the law of friction limits.
//!
//! Trial traction q = P R t° + κ ε s: the traction t° of the last accepted state, rotated with the facet by R, and the weighted
//! slip s of the pair since then. Stick: t = q. Slip: t = b(ε g̃) τ, with b the bound of the law and τ the direction of the trial
//! traction of all pairs of the node; in space the tangent knows how it rotates. An active node has the force p = f (ε g̃ n + t),
//! which acts through D and M.

use zelus_core::scalar::Real;
use zelus_core::vector3::{add, scale};

use super::alm_frictional::AlmFrictional;
use super::penalty_by_node::PenaltyByNode;
use crate::law::rules::{self, Decision, SlaveNumbers, SlipRule};
use crate::law::{Multiplier, NodeForces, NodeInputs, NodeLaw, NodeState, SlaveNode, SlipMeasure, StepParameters};
use crate::pairs::{ByNode, Formulation, Friction};
use crate::register_contact_formulation;

/// Penalty method with friction, of weighted gaps and slips.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PenaltyFrictional {
    /// Ratio κ of tangential to normal penalty.
    pub tangent_factor: f64,
}

impl PenaltyFrictional {
    /// Trial traction q of a slave node.
    fn trial<T: Real>(&self, node: &SlaveNode, inputs: &NodeInputs<T>) -> [T; 3] {
        add(inputs.history, scale(inputs.slip, T::constant(self.tangent_factor * node.penalty)))
    }
}

/// The direction τ of a sliding node; its change with the trial traction of a pair is nothing but a derivative.
fn direction<T: Real>(node: &SlaveNode, trial: [T; 3]) -> [T; 3] {
    let change = trial.map(|q| (q - q.value()) * node.rotation.by_slip);
    let along = change[0] * node.tangent[0] + change[1] * node.tangent[1] + change[2] * node.tangent[2];
    std::array::from_fn(|c| change[c] - along * node.tangent[c] + node.tangent[c])
}

impl NodeLaw for PenaltyFrictional {
    const MULTIPLIER: Multiplier = Multiplier::None;

    fn new(parameters: &StepParameters) -> Self {
        Self { tangent_factor: parameters.tangent_factor }
    }

    fn slip(&self) -> SlipMeasure {
        SlipMeasure::Rotated
    }

    fn has_history(&self) -> bool {
        true
    }

    fn weighted_trial(&self, node: &SlaveNode, inputs: &NodeInputs<f64>) -> Option<[f64; 3]> {
        Some(scale(self.trial(node, inputs), inputs.area))
    }

    fn decide(node: &SlaveNumbers, rule: SlipRule) -> Decision {
        rules::penalty_frictional(node, rule)
    }

    fn evaluate<T: Real>(&self, node: &SlaveNode, inputs: &NodeInputs<T>) -> NodeForces<T> {
        let pressure = inputs.gap * node.penalty;
        let trial = self.trial(node, inputs);
        let traction = match node.state {
            NodeState::Inactive => return NodeForces::none(),
            NodeState::Stick => trial,
            NodeState::Slip => scale(direction(node, trial), node.friction.at(pressure)),
        };
        NodeForces::force(add(scale(inputs.normal, pressure), traction).map(|p| p * node.dynamic_factor))
    }
}

/// Pair by pair.
pub(super) const BY_PAIR: Formulation = Formulation {
    friction: Friction::Coulomb,
    ..Formulation::of::<PenaltyFrictional>(
        "PenaltyFrictionalMortarContactCondition",
        &[
            ("NORMAL", 3),
            ("VECTOR_LAGRANGE_MULTIPLIER", 3),
            ("WEIGHTED_GAP", 1),
            ("WEIGHTED_SLIP", 3),
            ("FRICTION_TRACTION", 3),
        ],
    )
};

/// By node, with a multiplier a node and direction.
static IMPLICIT: Formulation = Formulation {
    friction: Friction::Coulomb,
    regularised: true,
    ..Formulation::of::<AlmFrictional>(BY_PAIR.condition, BY_PAIR.variables)
};

/// By node, in explicit steps.
static EXPLICIT: Formulation = Formulation {
    friction: Friction::Coulomb,
    decide: rules::penalty_frictional,
    ..Formulation::of::<PenaltyByNode>(BY_PAIR.condition, BY_PAIR.variables)
};

register_contact_formulation! { "PenaltyContactFrictional",
    about: "Coulomb friction, penalty method",
    source: "normal: eq. D.3; friction: Wriggers, Vu Van and Stein (1990)",
    conditions: ["PenaltyFrictionalMortarContactCondition", "PenaltyFrictionalAxisymMortarContactCondition"],
    build: Formulation { by_node: Some(ByNode { implicit: &IMPLICIT, explicit: &EXPLICIT }), ..BY_PAIR },
}
