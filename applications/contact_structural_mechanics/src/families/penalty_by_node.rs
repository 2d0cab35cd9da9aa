//! Penalties by node in explicit steps: p = f t, with the traction t = ε g n + t_t of the whole node, its gap g = g̃/A over all pairs.
//!
//! t_t is the elastic trial traction P R t° + κ ε s/A of the whole node, cut to the bound of the law of friction; zero without
//! friction. Where steps iterate, the same tractions are multipliers of surfaces that give way, see [`super::alm_frictional`].

use zelus_core::geometry::{FacetShape, NodeArray};
use zelus_core::scalar::Real;
use zelus_core::vector3::{constant, scale};

use crate::formulations::{Formulation, Kinematics, LastState, Multiplier, PairResidual, SlaveNode, StepParameters};

/// Penalty method by node, with or without friction. Its tangent is that of given tractions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PenaltyByNode {
    /// Ratio κ of tangential to normal penalty.
    pub tangent_factor: f64,
}

impl Formulation for PenaltyByNode {
    const MULTIPLIER: Multiplier = Multiplier::None;
    type History<S: FacetShape, M: FacetShape> = LastState<S, M>;

    fn new(parameters: &StepParameters) -> Self {
        Self { tangent_factor: parameters.tangent_factor }
    }

    fn weighted_slip<S: FacetShape, M: FacetShape>(
        &self,
        pair: &Kinematics<f64, S, M>,
        last: &LastState<S, M>,
    ) -> S::Nodal<[f64; 3]> {
        last.slip(pair)
    }

    fn weighted_trial<S: FacetShape, M: FacetShape>(
        &self,
        pair: &Kinematics<f64, S, M>,
        nodes: &S::Nodal<SlaveNode>,
        last: &LastState<S, M>,
    ) -> Option<S::Nodal<[f64; 3]>> {
        Some(last.weighted_trial(pair, nodes, self.tangent_factor))
    }

    fn residual<T: Real, S: FacetShape, M: FacetShape>(
        &self,
        pair: &Kinematics<T, S, M>,
        nodes: &S::Nodal<SlaveNode>,
        _: &LastState<S, M>,
    ) -> PairResidual<T, S, M> {
        let mut out = PairResidual::zero();
        for (j, node) in nodes.iter().enumerate().filter(|(_, node)| node.state.is_active()) {
            out.add_nodal_force(&pair.operators, j, constant(scale(node.traction, node.dynamic_factor)));
        }
        out
    }
}
