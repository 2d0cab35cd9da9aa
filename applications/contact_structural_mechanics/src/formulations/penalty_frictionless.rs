//! Frictionless contact by the penalty method (eq. D.3d): p = f ε ḡ n on active nodes, no multipliers.
//!
//! ḡ = g̃ is the weighted gap of the pair, as in Kratos, or its mean gap at the node, g̃/D: a node then bears ε g̃ of all its
//! pairs together, and an even gap gives an even pressure, whatever the areas of the pairs.

use super::{Formulation, Kinematics, Multipliers, PairResidual, SlaveNode};
use zelus_core::scalar::Real;
use zelus_core::vector3::scale;

/// Penalty method without friction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PenaltyFrictionless {
    /// Whether the penalty counts weighted gaps.
    pub weighted: bool,
}

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
            let pressure = gap[j] * pair.counted(j, self.weighted) * (node.penalty * node.dynamic_factor);
            out.add_nodal_force(&pair.operators, j, scale(pair.normals[j], pressure));
        }
        out
    }
}
