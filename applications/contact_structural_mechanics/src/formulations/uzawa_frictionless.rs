//! Frictionless contact by Uzawa's iteration on the penalty kernel (eq. D.10).
//!
//! Active: p = f (k λ + ε ḡ) n with λ constant and the mean gap ḡ = g̃/D; an outer loop updates it, k λ ← k λ + ε ḡ.
//! Inactive: p = 0.

use super::{Formulation, Kinematics, Multipliers, PairResidual, SlaveNode};
use zelus_core::scalar::Real;
use zelus_core::vector3::scale;

/// Penalty method with a multiplier that is no unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UzawaFrictionless {
    /// Scale factor k of the multipliers: pressure = k λ.
    pub scale_factor: f64,
}

impl Formulation for UzawaFrictionless {
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
            let spring = gap[j] / pair.area(j) * node.penalty;
            let pressure = (pair.multipliers[j][0] * self.scale_factor + spring) * node.dynamic_factor;
            out.add_nodal_force(&pair.operators, j, scale(pair.normals[j], pressure));
        }
        out
    }
}
