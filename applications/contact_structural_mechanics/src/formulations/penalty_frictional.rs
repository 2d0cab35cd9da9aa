//! Friction by the penalty method.
//!
//! Normal part p = f ε g̃ n through D and M. Tangential part t = b(ε g̃) τ (slip, b the bound of the law) or κ ε s
//! (stick) through the *changes* of the operators since the start of the step: b_slave −= f (D − D°)ᵀ P t, b_master +=
//! f (M − M°)ᵀ P t, with s objective.

use super::{Formulation, Kinematics, Multipliers, NodeState, PairResidual, SlaveNode};
use crate::mortar::{Operators, objective_slip, tangential};
use zelus_core::scalar::Real;
use zelus_core::vector3::scale;

/// Penalty method with friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PenaltyFrictional {
    /// Ratio κ of tangential to normal penalty.
    pub tangent_factor: f64,
}

impl Formulation for PenaltyFrictional {
    const MULTIPLIERS: Multipliers = Multipliers::None;
    /// D° and M°, at the start of the step.
    type History<const NS: usize, const NM: usize> = Operators<f64, NS, NM>;

    fn residual<T: Real, const NS: usize, const NM: usize>(
        &self,
        pair: &Kinematics<T, NS, NM>,
        nodes: &[SlaveNode; NS],
        previous: &Operators<f64, NS, NM>,
    ) -> PairResidual<T, NS, NM> {
        let gap = pair.gap();
        let change = pair.operators.minus(previous);
        let slip = objective_slip(&pair.operators, previous, &pair.slave, &pair.master, &pair.normals);
        let mut out = PairResidual::zero();
        for (j, node) in nodes.iter().enumerate() {
            let n = pair.normals[j];
            let pressure = gap[j] * node.penalty;
            let friction = match node.state {
                NodeState::Inactive => continue,
                NodeState::Slip => node.tangent.map(|t| node.friction.at(pressure) * t),
                NodeState::Stick => slip[j].map(|s| s * (self.tangent_factor * node.penalty)),
            };
            out.add_nodal_force(&pair.operators, j, scale(n, pressure * node.dynamic_factor));
            out.add_nodal_force(&change, j, tangential(friction, n).map(|t| t * -node.dynamic_factor));
        }
        out
    }
}
