//! Frictionless contact by the perturbed Lagrangian with a scalar multiplier.
//!
//! ∫ k λ g − (k λ)²/(2ε): active: p = f k λ n and b_λ = k (g̃ − D_jj k λ/ε), so that the pressure is ε times the mean
//! gap of the node. Inactive: p = 0 and b_λ = −k² (A/ε) λ. Tends to the Lagrange multiplier method as ε grows, without its
//! zero diagonal.

use super::{Formulation, Kinematics, Multipliers, PairResidual, SlaveNode};
use zelus_core::scalar::Real;
use zelus_core::vector3::scale;

/// Perturbed Lagrangian, normal multiplier.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PerturbedLagrangianFrictionless {
    /// Scale factor k of the multipliers: pressure = k λ.
    pub scale_factor: f64,
}

impl Formulation for PerturbedLagrangianFrictionless {
    const MULTIPLIERS: Multipliers = Multipliers::Normal;
    type History<const NS: usize, const NM: usize> = ();

    fn residual<T: Real, const NS: usize, const NM: usize>(
        &self,
        pair: &Kinematics<T, NS, NM>,
        nodes: &[SlaveNode; NS],
        (): &(),
    ) -> PairResidual<T, NS, NM> {
        let k = self.scale_factor;
        let gap = pair.gap();
        let mut out = PairResidual::zero();
        for (j, node) in nodes.iter().enumerate() {
            let lambda = pair.multipliers[j][0];
            if node.state.is_active() {
                out.add_nodal_force(&pair.operators, j, scale(pair.normals[j], lambda * (k * node.dynamic_factor)));
                out.multipliers[j][0] = (gap[j] - pair.area(j) * lambda * (k / node.penalty)) * k;
            } else {
                out.multipliers[j][0] = lambda * (-k * k * node.area / node.penalty);
            }
        }
        out
    }
}
