//! Frictionless contact by the penalty method.

use zelus_core::register;
use zelus_core::registry::Build;

use super::shapes::{self, register_shapes};
use crate::formulations::PenaltyFrictionless;
use crate::interaction::StepParameters;
use crate::mortar::PairGeometry;
use crate::pairs::{Family, Friction, Multiplier, Pair, PairFormulation};

impl PairFormulation for PenaltyFrictionless {
    fn new(parameters: &StepParameters) -> Self {
        Self { weighted: parameters.weighted_penalty }
    }

    fn multiplier() -> Multiplier {
        Multiplier::None
    }

    fn history<const NS: usize, const NM: usize>(_: &Pair, _: &PairGeometry<f64, NS, NM>) {}
}

register! { Condition "PenaltyContactFrictionless",
    about: "frictionless contact, penalty method",
    source: "eq. D.3",
    build: Build::Factory(&Family {
        condition: "PenaltyFrictionlessMortarContactCondition",
        multiplier: Multiplier::None,
        variables: &[("NORMAL", 3), ("WEIGHTED_GAP", 1)],
        friction: Friction::None,
        penalty: true,
        weighted_gaps: false,
        block: shapes::block::<PenaltyFrictionless>,
    }),
}
register_shapes!(
    "PenaltyFrictionlessMortarContactCondition",
    "PenaltyFrictionlessAxisymMortarContactCondition2D2N",
    "pair of the family PenaltyContactFrictionless"
);
