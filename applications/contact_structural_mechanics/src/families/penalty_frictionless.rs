//! Frictionless contact by the penalty method (eq. D.3d), pair by pair as in Kratos: p = f ε g̃ n on active nodes.
//!
//! ε g̃ holds an area: it counts the weighted gap of the pair.

use zelus_core::geometry::{FacetShape, NodeArray};
use zelus_core::scalar::Real;
use zelus_core::vector3::scale;

use super::alm_frictionless::AlmFrictionless;
use super::penalty_by_node::PenaltyByNode;
use crate::formulations::{Formulation, Kinematics, Multiplier, PairResidual, SlaveNode, StepParameters};
use crate::pairs::{ByNode, Family};
use crate::register_contact_family;

/// Penalty method without friction, of weighted gaps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PenaltyFrictionless;

impl Formulation for PenaltyFrictionless {
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
            let pressure = gap[j] * (node.penalty * node.dynamic_factor);
            out.add_nodal_force(&pair.operators, j, scale(pair.normals[j], pressure));
        }
        out
    }
}

/// Pair by pair.
const BY_PAIR: Family = Family::of::<PenaltyFrictionless>(
    "PenaltyFrictionlessMortarContactCondition",
    &[("NORMAL", 3), ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", 1), ("WEIGHTED_GAP", 1)],
);

/// By node, with a multiplier a node.
static IMPLICIT: Family =
    Family { compliant: true, ..Family::of::<AlmFrictionless>(BY_PAIR.condition, BY_PAIR.variables) };

/// By node, in explicit steps.
static EXPLICIT: Family = Family::of::<PenaltyByNode>(BY_PAIR.condition, BY_PAIR.variables);

register_contact_family! { "PenaltyContactFrictionless",
    about: "frictionless contact, penalty method",
    source: "eq. D.3",
    conditions: ["PenaltyFrictionlessMortarContactCondition", "PenaltyFrictionlessAxisymMortarContactCondition"],
    build: Family { by_node: Some(ByNode { implicit: &IMPLICIT, explicit: &EXPLICIT }), ..BY_PAIR },
}
