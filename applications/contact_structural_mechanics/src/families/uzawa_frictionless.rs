//! Frictionless contact, penalty method whose error an outer loop of multiplier updates takes away.

use zelus_core::register;
use zelus_core::registry::Build;

use super::shapes::{self, register_shapes};
use crate::formulations::UzawaFrictionless;
use crate::interaction::StepParameters;
use crate::mortar::PairGeometry;
use crate::pairs::{Family, Friction, Multiplier, Pair, PairFormulation};
use crate::variables::LAGRANGE_MULTIPLIER_CONTACT_PRESSURE;

impl PairFormulation for UzawaFrictionless {
    fn new(parameters: &StepParameters) -> Self {
        Self { scale_factor: parameters.scale_factor }
    }

    fn multiplier() -> Multiplier {
        Multiplier::Outer(&LAGRANGE_MULTIPLIER_CONTACT_PRESSURE)
    }

    fn history<const NS: usize, const NM: usize>(_: &Pair, _: &PairGeometry<f64, NS, NM>) {}
}

register! { Condition "UzawaContactFrictionless",
    about: "frictionless contact, penalty method whose error an outer loop of multiplier updates takes away",
    source: "eq. D.10",
    build: Build::Factory(&Family {
        condition: "UzawaFrictionlessMortarContactCondition",
        multiplier: Multiplier::Outer(&LAGRANGE_MULTIPLIER_CONTACT_PRESSURE),
        variables: &[("NORMAL", 3), ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", 1), ("WEIGHTED_GAP", 1)],
        friction: Friction::None,
        penalty: true,
        weighted_gaps: false,
        compliant: false,
        by_node: None,
        block: shapes::block::<UzawaFrictionless>,
    }),
}
register_shapes!(
    "UzawaFrictionlessMortarContactCondition",
    "UzawaFrictionlessAxisymMortarContactCondition2D2N",
    "pair of the family UzawaContactFrictionless"
);
