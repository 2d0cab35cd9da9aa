//! Penalties by node in explicit steps: p = f t, with the traction t = ε g n + t_t of the whole node, its gap g = g̃/A over all pairs.
//!
//! t_t is the elastic trial traction P R t° + κ ε s/A of the whole node, cut to the bound of the law of friction; zero without
//! friction. Where steps iterate, the same tractions are multipliers of surfaces that give way, see [`super::alm_frictional`].

use zelus_core::scalar::Real;
use zelus_core::vector3::{add, constant, scale};

use crate::formulations::StepParameters;
use crate::formulations::{Formulation, Kinematics, LastState, Multiplier, PairResidual, SlaveNode};
use crate::mortar::{Operators, PairGeometry};

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

    fn history<const NS: usize, const NM: usize>(
        _: Operators<f64, NS, NM>,
        last: &PairGeometry<f64, NS, NM>,
    ) -> LastState<NS, NM> {
        LastState::new(last)
    }

    fn weighted_slip<const NS: usize, const NM: usize>(
        &self,
        pair: &Kinematics<f64, NS, NM>,
        last: &LastState<NS, NM>,
    ) -> [[f64; 3]; NS] {
        last.slip(pair)
    }

    /// A times the trial tractions P R t° + κ ε s/A.
    fn weighted_trial<const NS: usize, const NM: usize>(
        &self,
        pair: &Kinematics<f64, NS, NM>,
        nodes: &[SlaveNode; NS],
        last: &LastState<NS, NM>,
    ) -> Option<[[f64; 3]; NS]> {
        let (carried, slip) = (last.carried(pair, nodes), last.slip(pair));
        Some(std::array::from_fn(|j| {
            add(scale(carried[j], pair.area(j)), scale(slip[j], self.tangent_factor * nodes[j].penalty))
        }))
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
