//! Friction by the penalty method, pair by pair: an elastic slip that the law of friction limits.
//!
//! Trial traction q = P R t° + κ ε s: the traction t° of the last accepted state, turned with the facet by R, and the weighted
//! slip s of the pair since then. Stick: t = q. Slip: t = b(ε g̃) τ, with b the bound of the law and τ the direction of the trial
//! traction of all pairs of the node; in space the tangent knows how it turns. An active node has the force p = f (ε g̃ n + t),
//! which acts through D and M.

use super::{Formulation, Kinematics, Multipliers, NodeState, PairResidual, SlaveNode};
use crate::mortar::{Turn, tangential, turned_slip};
use zelus_core::scalar::Real;
use zelus_core::vector3::{add, constant, scale};

/// Penalty method with friction, of weighted gaps and slips.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PenaltyFrictional {
    /// Ratio κ of tangential to normal penalty.
    pub tangent_factor: f64,
}

/// A pair as it was in the last accepted state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LastState<const NS: usize, const NM: usize> {
    /// Positions of the slave nodes.
    pub slave: [[f64; 3]; NS],
    /// Positions of the master nodes.
    pub master: [[f64; 3]; NM],
}

impl PenaltyFrictional {
    /// Weighted slips s of a pair since its last accepted state.
    pub fn slip<T: Real, const NS: usize, const NM: usize>(
        pair: &Kinematics<T, NS, NM>,
        last: &LastState<NS, NM>,
    ) -> [[T; 3]; NS] {
        turned_slip(&pair.operators, (&pair.slave, &last.slave), (&pair.master, &last.master), &pair.normals)
    }

    /// Tractions P R t° that the slave nodes of a pair have from its last accepted state.
    pub fn carried<T: Real, const NS: usize, const NM: usize>(
        pair: &Kinematics<T, NS, NM>,
        nodes: &[SlaveNode; NS],
        last: &LastState<NS, NM>,
    ) -> [[T; 3]; NS] {
        let turn = Turn::of_facet(&pair.slave, &last.slave);
        std::array::from_fn(|j| tangential(turn.apply(constant(nodes[j].carried)), pair.normals[j]))
    }

    /// Trial tractions q of the slave nodes of a pair.
    pub fn trial<T: Real, const NS: usize, const NM: usize>(
        &self,
        pair: &Kinematics<T, NS, NM>,
        nodes: &[SlaveNode; NS],
        last: &LastState<NS, NM>,
    ) -> [[T; 3]; NS] {
        let (carried, slip) = (Self::carried(pair, nodes, last), Self::slip(pair, last));
        std::array::from_fn(|j| add(carried[j], scale(slip[j], T::constant(self.tangent_factor * nodes[j].penalty))))
    }
}

/// The direction τ of a sliding node; what it turns by with the trial traction of a pair is nothing but a derivative.
fn direction<T: Real>(node: &SlaveNode, trial: [T; 3]) -> [T; 3] {
    let change = trial.map(|q| (q - q.value()) * node.turning.by_slip);
    let along = change[0] * node.tangent[0] + change[1] * node.tangent[1] + change[2] * node.tangent[2];
    std::array::from_fn(|c| change[c] - along * node.tangent[c] + node.tangent[c])
}

impl Formulation for PenaltyFrictional {
    const MULTIPLIERS: Multipliers = Multipliers::None;
    type History<const NS: usize, const NM: usize> = LastState<NS, NM>;

    fn residual<T: Real, const NS: usize, const NM: usize>(
        &self,
        pair: &Kinematics<T, NS, NM>,
        nodes: &[SlaveNode; NS],
        last: &LastState<NS, NM>,
    ) -> PairResidual<T, NS, NM> {
        let gap = pair.gap();
        let trial = self.trial(pair, nodes, last);
        let mut out = PairResidual::zero();
        for (j, node) in nodes.iter().enumerate() {
            let pressure = gap[j] * node.penalty;
            let traction = match node.state {
                NodeState::Inactive => continue,
                NodeState::Stick => trial[j],
                NodeState::Slip => scale(direction(node, trial[j]), node.friction.at(pressure)),
            };
            let force = add(scale(pair.normals[j], pressure), traction);
            out.add_nodal_force(&pair.operators, j, force.map(|p| p * node.dynamic_factor));
        }
        out
    }
}
