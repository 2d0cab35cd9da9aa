//! Frictionless contact by the augmented Lagrangian with a scalar multiplier (eq. 4.9, D.11).
//!
//! Active: p = f (k λ + ε̂ g̃) n and b_λ = k (g̃ − A (k λ − p°)/ε). Inactive: p = 0 and b_λ = −k² (A/c) λ. λ < 0 in compression.
//!
//! 1/ε is zero but for the perturbed Lagrangian, ∫ k λ g − (k λ)²/(2ε), and for penalties by node: over the pairs of a node its
//! pressure k λ is then ε times its gap. p° is zero but for Uzawa's iteration (eq. D.10), which updates it outside, p° ← k λ, until
//! k λ − p° and with it the gap vanish.

use zelus_core::geometry::{FacetShape, NodeArray};
use zelus_core::scalar::Real;
use zelus_core::vector3::scale;

use crate::formulations::{Augmentation, Formulation, Kinematics, Multiplier, PairResidual, SlaveNode, StepParameters};
use crate::pairs::Family;
use crate::register_contact_family;
use crate::variables::LAGRANGE_MULTIPLIER_CONTACT_PRESSURE;

/// Augmented Lagrangian, normal multiplier.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlmFrictionless {
    /// Scale factor k of the multipliers: pressure = k λ.
    pub scale_factor: f64,
    /// Where the gap augments the force.
    pub augmentation: Augmentation,
}

impl Formulation for AlmFrictionless {
    const MULTIPLIER: Multiplier = Multiplier::Scalar(&LAGRANGE_MULTIPLIER_CONTACT_PRESSURE);
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
            let lambda = pair.multipliers[j][0];
            if node.state.is_active() {
                let pressure = (lambda * k + gap[j] * self.augmentation.penalty(node)) * node.dynamic_factor;
                out.add_nodal_force(&pair.operators, j, scale(pair.normals[j], pressure));
                let gives_way = lambda * k - node.kept;
                out.multipliers[j][0] = (gap[j] - pair.area(j) * gives_way * node.compliance) * k;
            } else {
                out.multipliers[j][0] = lambda * (-k * k * self.augmentation.softness(node));
            }
        }
        out
    }
}

register_contact_family! { "ALMContactFrictionless",
    about: "frictionless contact, augmented Lagrangian, one multiplier a slave node along its normal",
    source: "eq. 4.9, D.11",
    conditions: ["ALMFrictionlessMortarContactCondition", "ALMFrictionlessAxisymMortarContactCondition"],
    build: Family {
        weighted_gaps: true,
        ..Family::of::<AlmFrictionless>(
            "ALMFrictionlessMortarContactCondition",
            &[("NORMAL", 3), ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", 1), ("WEIGHTED_GAP", 1), ("WEIGHTED_SCALAR_RESIDUAL", 1)],
        )
    },
}
