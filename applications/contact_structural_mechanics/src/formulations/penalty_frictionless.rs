//! Frictionless contact by the penalty method (eq. D.3d), pair by pair as in Kratos: p = f ε g̃ n on active nodes.
//!
//! ε g̃ holds an area: it counts the weighted gap of the pair.

use super::{Formulation, Kinematics, Multipliers, PairResidual, SlaveNode};
use zelus_core::scalar::Real;
use zelus_core::vector3::scale;

/// Penalty method without friction, of weighted gaps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PenaltyFrictionless;

impl Formulation for PenaltyFrictionless {
    const MULTIPLIERS: Multipliers = Multipliers::None;
    type History<const NS: usize, const NM: usize> = ();

    fn residual<T: Real, const NS: usize, const NM: usize>(
        &self,
        pair: &Kinematics<T, NS, NM>,
        nodes: &[SlaveNode; NS],
        (): &(),
    ) -> PairResidual<T, NS, NM> {
        let gap = pair.gap();
        let mut out = PairResidual::zero();
        for (j, node) in nodes.iter().enumerate().filter(|(_, node)| node.state.is_active()) {
            let pressure = gap[j] * (node.penalty * node.dynamic_factor);
            out.add_nodal_force(&pair.operators, j, scale(pair.normals[j], pressure));
        }
        out
    }
}
