//! Frictionless contact by the augmented Lagrangian with a vector multiplier.
//!
//! Active: p = f (k λ + ε̂ g̃ n) and b_λ = k g̃ n − k² (A/c) P λ, which drives the tangential part to zero.
//! Inactive: p = 0 and b_λ = −k² (A/c) λ.

use zelus_core::geometry::{FacetShape, NodeArray};
use zelus_core::scalar::Real;

use crate::formulations::{Augmentation, Formulation, Kinematics, Multiplier, PairResidual, SlaveNode, StepParameters};
use crate::mortar::tangential;
use crate::pairs::Family;
use crate::register_contact_family;
use crate::variables::VECTOR_LAGRANGE_MULTIPLIER;

/// Augmented Lagrangian, multiplier by components, no friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlmFrictionlessComponents {
    /// Scale factor k of the multipliers: traction = k λ.
    pub scale_factor: f64,
    /// Where the gap augments the force.
    pub augmentation: Augmentation,
}

impl Formulation for AlmFrictionlessComponents {
    const MULTIPLIER: Multiplier = Multiplier::Vector(&VECTOR_LAGRANGE_MULTIPLIER);
    type History<S: FacetShape, M: FacetShape> = ();

    fn new(parameters: &StepParameters) -> Self {
        Self { scale_factor: parameters.scale_factor, augmentation: parameters.augmentation }
    }

    fn residual<T: Real, S: FacetShape, M: FacetShape>(
        &self,
        pair: &Kinematics<T, S, M>,
        nodes: &S::Nodal<SlaveNode>,
        (): &(),
    ) -> PairResidual<T, S, M> {
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

register_contact_family! { "ALMContactFrictionlessComponents",
    about: "frictionless contact, augmented Lagrangian, one multiplier a slave node and direction",
    source: "eq. 4.9, D.11 by components",
    conditions: [
        "ALMFrictionlessComponentsMortarContactCondition", "ALMFrictionlessComponentsAxisymMortarContactCondition"
    ],
    build: Family {
        weighted_gaps: true,
        ..Family::of::<AlmFrictionlessComponents>(
            "ALMFrictionlessComponentsMortarContactCondition",
            &[("NORMAL", 3), ("VECTOR_LAGRANGE_MULTIPLIER", 3), ("WEIGHTED_GAP", 1), ("WEIGHTED_VECTOR_RESIDUAL", 3)],
        )
    },
}
