//! Frictionless contact by a penalty that stiffens with depth, pair by pair: p = ε g̃ (1 + g²/A) n on active nodes.
//!
//! g = g̃/A is the gap of the pair (length), negative in penetration, and A its area; √A stands for the size of a facet, so
//! that the pressure is twice that of the linear penalty where it is as deep as a facet is long.

use zelus::contact_structural_mechanics::formulations::{
    Formulation, Kinematics, Multiplier, PairResidual, SlaveNode, StepParameters,
};
use zelus::contact_structural_mechanics::pairs::Family;
use zelus::contact_structural_mechanics::register_contact_family;
use zelus_core::geometry::{FacetShape, NodeArray};
use zelus_core::scalar::Real;
use zelus_core::vector3::scale;

#[derive(Debug, Clone, Copy)]
struct HardeningPenalty;

impl Formulation for HardeningPenalty {
    const MULTIPLIER: Multiplier = Multiplier::None;
    type History<S: FacetShape, M: FacetShape> = ();

    fn new(_: &StepParameters) -> Self {
        Self
    }

    fn residual<T: Real, S: FacetShape, M: FacetShape>(
        &self,
        pair: &Kinematics<T, S, M>,
        nodes: &S::Nodal<SlaveNode>,
        (): &(),
    ) -> PairResidual<T, S, M> {
        let gap = pair.gap();
        let mut out = PairResidual::zero();
        for (j, node) in nodes.iter().enumerate().filter(|(_, node)| node.state.is_active()) {
            let depth = gap[j] / node.area;
            let pressure = gap[j] * (depth * depth / node.area + 1.0) * (node.penalty * node.dynamic_factor);
            out.add_nodal_force(&pair.operators, j, scale(pair.normals[j], pressure));
        }
        out
    }
}

register_contact_family! { "HardeningPenaltyContactFrictionless",
    about: "frictionless contact by a penalty that stiffens with depth",
    source: "a cubic spring",
    conditions: [
        "HardeningPenaltyFrictionlessMortarContactCondition",
        "HardeningPenaltyFrictionlessAxisymMortarContactCondition"
    ],
    build: Family::of::<HardeningPenalty>(
        "HardeningPenaltyFrictionlessMortarContactCondition",
        &[("NORMAL", 3), ("WEIGHTED_GAP", 1)],
    ),
}
