//! Frictionless contact by the augmented Lagrangian with a vector multiplier.
//!
//! Active: p = f (k λ + ε̂ g̃ n) and b_λ = k g̃ n − k² (A/c) P λ, which drives the tangential part to zero.
//! Inactive: p = 0 and b_λ = −k² (A/c) λ.

use super::{Augmentation, Formulation, Kinematics, Multipliers, PairResidual, SlaveNode};
use crate::mortar::tangential;
use zelus_core::scalar::Real;

/// Augmented Lagrangian, multiplier by components, no friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlmFrictionlessComponents {
    /// Scale factor k of the multipliers: traction = k λ.
    pub scale_factor: f64,
    /// Where the gap augments the force.
    pub augmentation: Augmentation,
}

impl Formulation for AlmFrictionlessComponents {
    const MULTIPLIERS: Multipliers = Multipliers::Vector;
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
            let (lambda, n) = (pair.multipliers[j], pair.normals[j]);
            let release = -k * k * self.augmentation.softness(node);
            if node.state.is_active() {
                let normal = gap[j] * self.augmentation.penalty(node);
                let traction = std::array::from_fn(|c| (lambda[c] * k + n[c] * normal) * node.dynamic_factor);
                out.add_nodal_force(&pair.operators, j, traction);
                let sliding = tangential(lambda, n);
                out.multipliers[j] = std::array::from_fn(|c| n[c] * gap[j] * k + sliding[c] * release);
            } else {
                out.multipliers[j] = lambda.map(|x| x * release);
            }
        }
        out
    }
}
