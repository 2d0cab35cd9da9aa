//! Penalties by node in explicit steps: p = f t, with the traction t = ε g n + t_t of the whole node, its gap g = g̃/A over all pairs.
//!
//! t_t is the elastic trial traction P R t° + κ ε s/A of the whole node, cut to the bound of the law of friction; zero without
//! friction. Where steps iterate, the same tractions are multipliers of surfaces that give way, see [`super::alm_frictional`].

use super::{Formulation, Kinematics, LastState, Multipliers, PairResidual, PenaltyFrictional, SlaveNode};
use zelus_core::scalar::Real;
use zelus_core::vector3::{add, constant, scale};

/// Penalty method by node, with or without friction. Its tangent is that of given tractions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PenaltyByNode {
    /// Ratio κ of tangential to normal penalty.
    pub tangent_factor: f64,
}

impl PenaltyByNode {
    /// A times the trial tractions P R t° + κ ε s/A of the slave nodes of a pair.
    pub fn trial<const NS: usize, const NM: usize>(
        &self,
        pair: &Kinematics<f64, NS, NM>,
        nodes: &[SlaveNode; NS],
        last: &LastState<NS, NM>,
    ) -> [[f64; 3]; NS] {
        let (carried, slip) = (PenaltyFrictional::carried(pair, nodes, last), PenaltyFrictional::slip(pair, last));
        std::array::from_fn(|j| {
            add(scale(carried[j], pair.area(j)), scale(slip[j], self.tangent_factor * nodes[j].penalty))
        })
    }
}

impl Formulation for PenaltyByNode {
    const MULTIPLIERS: Multipliers = Multipliers::None;
    type History<const NS: usize, const NM: usize> = LastState<NS, NM>;

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
