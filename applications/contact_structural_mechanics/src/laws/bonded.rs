//! Surfaces with bonds: the traction of a node is that of its bond and of friction, see [`crate::law::bond`].
//!
//! It is a multiplier, p = f k λ, which couples the pairs of a node: b_λ = k/K_n Σ (A t − A k λ), K_n the normal stiffness. A t is linear
//! in the gap, the opening and the area of a pair, about the opening of the node: the sum over the pairs is the law itself, and its
//! derivative that of the law. A node without bond and contact has p = 0 and b_λ = −k² (A/c) λ.

use zelus_core::scalar::Real;
use zelus_core::vector3::{add, scale};

use super::penalty_frictional::BY_PAIR;
use crate::law::{
    Multiplier, NodeForces, NodeInputs, NodeLaw, SlaveNode, SlipMeasure, StepParameters,
    rules::{self, Decision, SlaveNumbers, SlipRule},
};
use crate::mortar::tangential;
use crate::pairs::{Formulation, Friction};
use crate::variables::VECTOR_LAGRANGE_MULTIPLIER;

/// Bonds with contact and friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bonded {
    /// Scale factor k of the multipliers: traction = k λ.
    pub scale_factor: f64,
    /// Ratio κ of tangential to normal stiffness of friction.
    pub tangent_factor: f64,
}

impl NodeLaw for Bonded {
    const MULTIPLIER: Multiplier = Multiplier::Vector(&VECTOR_LAGRANGE_MULTIPLIER);

    fn new(parameters: &StepParameters) -> Self {
        Self { scale_factor: parameters.scale_factor, tangent_factor: parameters.tangent_factor }
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

    fn decide(node: &SlaveNumbers, rule: SlipRule) -> Decision {
        rules::cohesive(node, rule)
    }

    fn evaluate<T: Real>(&self, node: &SlaveNode, inputs: &NodeInputs<T>) -> NodeForces<T> {
        let (k, lambda, n, area) = (self.scale_factor, inputs.multiplier, inputs.normal, inputs.area);
        let Some(bond) = node.bond.filter(|_| node.state.is_active()) else {
            let release = -k * k * node.area / node.stiffness;
            return NodeForces { force: None, multiplier: lambda.map(|x| x * release) };
        };
        let sliding = add(scale(inputs.sliding, area), inputs.slip);
        let elastic = scale(inputs.slip, T::constant(self.tangent_factor * node.penalty));
        let trial = add(scale(inputs.history, area), elastic);
        let (normal, along) = bond.weighted(area, (inputs.gap, sliding, trial));
        let along = tangential(along, n);
        let factor = k / node.penalty;
        let row = |c: usize| (n[c] * normal + along[c] - lambda[c] * area * k) * factor;
        NodeForces { force: Some(lambda.map(|x| x * (k * node.dynamic_factor))), multiplier: std::array::from_fn(row) }
    }
}

/// The formulation of the penalty method with friction where the deck has a law of bonds.
pub static BONDED: Formulation = Formulation {
    friction: Friction::Coulomb,
    regularised: true,
    ..Formulation::of::<Bonded>(BY_PAIR.condition, BY_PAIR.variables)
};
