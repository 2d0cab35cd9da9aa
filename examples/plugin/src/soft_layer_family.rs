//! Contact through a soft layer: the pressure is its stiffness times how far it is pressed in.
//!
//! Active: p = k λ n and b_λ = k (g̃ − A k λ/c): the gap of a node is its pressure over c = STIFFNESS (force per length cubed).
//! Inactive: p = 0 and λ is driven to zero. λ < 0 in compression.

use zelus::contact_structural_mechanics::formulations::{
    Augmentation, Formulation, Kinematics, Multiplier, PairResidual, SlaveNode, StepParameters,
};
use zelus::contact_structural_mechanics::pairs::Family;
use zelus::contact_structural_mechanics::register_contact_family;
use zelus::contact_structural_mechanics::variables::LAGRANGE_MULTIPLIER_CONTACT_PRESSURE as PRESSURE;
use zelus_core::geometry::{FacetShape, NodeArray};
use zelus_core::scalar::Real;
use zelus_core::vector3::scale;

const STIFFNESS: f64 = 500.0;

#[derive(Clone, Copy)]
struct SoftLayer {
    scale_factor: f64,
}

impl Formulation for SoftLayer {
    const MULTIPLIER: Multiplier = Multiplier::Scalar(&PRESSURE);
    type History<S: FacetShape, M: FacetShape> = ();

    fn new(parameters: &StepParameters) -> Self {
        Self { scale_factor: parameters.scale_factor }
    }

    fn residual<T: Real, S: FacetShape, M: FacetShape>(
        &self,
        pair: &Kinematics<T, S, M>,
        nodes: &S::Nodal<SlaveNode>,
        (): &(),
    ) -> PairResidual<T, S, M> {
        let (k, gap) = (self.scale_factor, pair.gap());
        let mut out = PairResidual::zero();
        for (j, node) in nodes.iter().enumerate() {
            let lambda = pair.multipliers[j][0];
            if node.state.is_active() {
                out.add_nodal_force(&pair.operators, j, scale(pair.normals[j], lambda * k));
                out.multipliers[j][0] = (gap[j] - pair.area(j) * lambda * k / STIFFNESS) * k;
            } else {
                out.multipliers[j][0] = lambda * (-k * k * Augmentation::Node.softness(node));
            }
        }
        out
    }
}

register_contact_family! { "ALMContactSoftLayer",
    about: "frictionless contact through a soft layer",
    source: "p = c g",
    conditions: ["SoftLayerMortarContactCondition", "SoftLayerAxisymMortarContactCondition"],
    build: Family::of::<SoftLayer>(
        "SoftLayerMortarContactCondition",
        &[("NORMAL", 3), ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", 1), ("WEIGHTED_GAP", 1)],
    ),
}
