//! Penalties by node in explicit steps: p = f t, with the traction t = ε g n + t_t of the whole node, its gap g = g̃/A over all pairs.
//!
//! t_t is the elastic trial traction P R t° + κ ε s/A of the whole node, cut to the bound of the law of friction; zero without
//! friction. Where steps iterate, the same tractions are multipliers of surfaces that give way, see [`super::alm_frictional`].

use zelus_core::scalar::Real;
use zelus_core::vector3::{constant, scale};

use crate::formulations::StepParameters;
use crate::formulations::{Formulation, Kinematics, LastState, Multiplier, PairResidual, SlaveNode};

/// Penalty method by node, with or without friction. Its tangent is that of given tractions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PenaltyByNode {
    /// Ratio κ of tangential to normal penalty.
    pub tangent_factor: f64,
}

impl Formulation for PenaltyByNode {
    const MULTIPLIER: Multiplier = Multiplier::None;
    type History<const NS: usize, const NM: usize> = LastState<NS, NM>;

    fn new(parameters: &StepParameters) -> Self {
        Self { tangent_factor: parameters.tangent_factor }
    }

    fn weighted_slip<const NS: usize, const NM: usize>(
        &self,
        pair: &Kinematics<f64, NS, NM>,
        last: &LastState<NS, NM>,
    ) -> [[f64; 3]; NS] {
        last.slip(pair)
    }

    fn weighted_trial<const NS: usize, const NM: usize>(
        &self,
        pair: &Kinematics<f64, NS, NM>,
        nodes: &[SlaveNode; NS],
        last: &LastState<NS, NM>,
    ) -> Option<[[f64; 3]; NS]> {
        Some(last.weighted_trial(pair, nodes, self.tangent_factor))
    }

    fn residual<T: Real, const NS: usize, const NM: usize>(
        &self,
        pair: &Kinematics<T, NS, NM>,
        nodes: &[SlaveNode; NS],
        _: &LastState<NS, NM>,
    ) -> PairResidual<T, NS, NM> {
        let mut out = PairResidual::zero();
        for (j, node) in nodes.iter().enumerate().filter(|(_, node)| node.state.is_active()) {
            out.add_nodal_force(&pair.operators, j, constant(scale(node.traction, node.dynamic_factor)));
        }
        out
    }
}
