//! Frictionless contact, perturbed Lagrangian, one multiplier a slave node along its normal.

use zelus_core::register;
use zelus_core::registry::Build;

use super::shapes::{self, register_shapes};
use crate::formulations::PerturbedLagrangianFrictionless;
use crate::interaction::StepParameters;
use crate::mortar::PairGeometry;
use crate::pairs::{Family, Friction, Multiplier, Pair, PairFormulation};
use crate::variables::LAGRANGE_MULTIPLIER_CONTACT_PRESSURE;

impl PairFormulation for PerturbedLagrangianFrictionless {
    fn new(parameters: &StepParameters) -> Self {
        Self { scale_factor: parameters.scale_factor }
    }

    fn multiplier() -> Multiplier {
        Multiplier::Scalar(&LAGRANGE_MULTIPLIER_CONTACT_PRESSURE)
    }

    fn history<const NS: usize, const NM: usize>(_: &Pair, _: &PairGeometry<f64, NS, NM>) {}
}

register! { Condition "PerturbedLagrangianContactFrictionless",
    about: "frictionless contact, perturbed Lagrangian, one multiplier a slave node along its normal",
    source: "Simo, Wriggers and Taylor (1985)",
    build: Build::Factory(&Family {
        condition: "PerturbedLagrangianFrictionlessMortarContactCondition",
        multiplier: Multiplier::Scalar(&LAGRANGE_MULTIPLIER_CONTACT_PRESSURE),
        variables: &[("NORMAL", 3), ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", 1), ("WEIGHTED_GAP", 1)],
        friction: Friction::None,
        penalty: false,
        weighted_gaps: false,
        block: shapes::block::<PerturbedLagrangianFrictionless>,
    }),
}
register_shapes!(
    "PerturbedLagrangianFrictionlessMortarContactCondition",
    "PerturbedLagrangianFrictionlessAxisymMortarContactCondition2D2N",
    "pair of the family PerturbedLagrangianContactFrictionless"
);
