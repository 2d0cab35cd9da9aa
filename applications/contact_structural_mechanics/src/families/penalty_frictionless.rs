//! Frictionless contact by the penalty method.

use crate::pairs::FamilyEntry;
use zelus_core::analysis::NodalVariable;
use zelus_core::register;

use super::shapes::{self, register_shapes};
use crate::formulations::{AlmFrictionless, PenaltyByNode, PenaltyFrictionless};
use crate::interaction::StepParameters;
use crate::mortar::PairGeometry;
use crate::pairs::{ByNode, Family, Friction, Multiplier, Pair, PairFormulation};
use crate::variables::LAGRANGE_MULTIPLIER_CONTACT_PRESSURE;

impl PairFormulation for PenaltyFrictionless {
    fn new(_: &StepParameters) -> Self {
        Self
    }

    fn multiplier() -> Multiplier {
        Multiplier::None
    }

    fn history<const NS: usize, const NM: usize>(_: &Pair, _: &PairGeometry<f64, NS, NM>) {}
}

const CONDITION: &str = "PenaltyFrictionlessMortarContactCondition";
const VARIABLES: &[NodalVariable] = &[("NORMAL", 3), ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", 1), ("WEIGHTED_GAP", 1)];

/// Pair by pair.
const BY_PAIR: Family = Family {
    condition: CONDITION,
    multiplier: Multiplier::None,
    variables: VARIABLES,
    friction: Friction::None,
    penalty: true,
    weighted_gaps: false,
    compliant: false,
    updated: false,
    by_node: None,
    block: shapes::block::<PenaltyFrictionless>,
};

/// By node, with a multiplier a node.
static IMPLICIT: Family = Family {
    multiplier: Multiplier::Scalar(&LAGRANGE_MULTIPLIER_CONTACT_PRESSURE),
    penalty: false,
    compliant: true,
    block: shapes::block::<AlmFrictionless>,
    ..BY_PAIR
};

/// By node, in explicit steps.
static EXPLICIT: Family = Family { block: shapes::block::<PenaltyByNode>, ..BY_PAIR };

register! { FamilyEntry "PenaltyContactFrictionless",
    about: "frictionless contact, penalty method",
    source: "eq. D.3",
    build: Family { by_node: Some(ByNode { implicit: &IMPLICIT, explicit: &EXPLICIT }), ..BY_PAIR },
}
register_shapes!(
    "PenaltyFrictionlessMortarContactCondition",
    "PenaltyFrictionlessAxisymMortarContactCondition2D2N",
    "pair of the family PenaltyContactFrictionless"
);
