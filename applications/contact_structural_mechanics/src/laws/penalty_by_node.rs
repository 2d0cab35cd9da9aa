//! Penalties by node in explicit steps: p = f t, with the traction t = ε g n + t_t of the whole node, its gap g = g̃/A over all pairs.
//!
//! t_t is the elastic trial traction P R t° + κ ε s/A of the whole node, cut to the bound of the law of friction; zero without
//! friction. Where steps iterate, the same tractions are multipliers of the regularised method, see [`super::alm_frictional`].

use zelus_core::scalar::Real;
use zelus_core::vector3::{add, constant, scale};

use crate::law::{Multiplier, NodeForces, NodeInputs, NodeLaw, SlaveNode, SlipMeasure, StepParameters};

/// Penalty method by node, with or without friction. Its tangent is that of given tractions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PenaltyByNode {
    /// Ratio κ of tangential to normal penalty.
    pub tangent_factor: f64,
}

impl NodeLaw for PenaltyByNode {
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
        Some(add(scale(inputs.history, inputs.area), scale(inputs.slip, self.tangent_factor * node.penalty)))
    }

    fn evaluate<T: Real>(&self, node: &SlaveNode, _: &NodeInputs<T>) -> NodeForces<T> {
        if !node.state.is_active() {
            return NodeForces::none();
        }
        NodeForces::force(constant(scale(node.traction, node.dynamic_factor)))
    }
}
