//! Frictionless contact by the augmented Lagrangian with a scalar multiplier.

use crate::pairs::FamilyEntry;
use zelus_core::register;

use super::shapes::{self, register_shapes};
use crate::formulations::AlmFrictionless;
use crate::interaction::StepParameters;
use crate::mortar::PairGeometry;
use crate::pairs::{Family, Friction, Multiplier, Pair, PairFormulation};
use crate::variables::LAGRANGE_MULTIPLIER_CONTACT_PRESSURE;

impl PairFormulation for AlmFrictionless {
    fn new(parameters: &StepParameters) -> Self {
        Self { scale_factor: parameters.scale_factor, augmentation: parameters.augmentation }
    }

    fn multiplier() -> Multiplier {
        Multiplier::Scalar(&LAGRANGE_MULTIPLIER_CONTACT_PRESSURE)
    }

    fn history<const NS: usize, const NM: usize>(_: &Pair, _: &PairGeometry<f64, NS, NM>) {}
}

register! { FamilyEntry "ALMContactFrictionless",
    about: "frictionless contact, augmented Lagrangian, one multiplier a slave node along its normal",
    source: "eq. 4.9, D.11",
    build: Family {
        condition: "ALMFrictionlessMortarContactCondition",
        multiplier: Multiplier::Scalar(&LAGRANGE_MULTIPLIER_CONTACT_PRESSURE),
        variables: &[("NORMAL", 3), ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", 1), ("WEIGHTED_GAP", 1), ("WEIGHTED_SCALAR_RESIDUAL", 1)],
        friction: Friction::None,
        penalty: false,
        weighted_gaps: true,
        compliant: false,
        updated: false,
        by_node: None,
        block: shapes::block::<AlmFrictionless>,
    },
}
register_shapes!(
    "ALMFrictionlessMortarContactCondition",
    "ALMFrictionlessAxisymMortarContactCondition2D2N",
    "pair of the family ALMContactFrictionless"
);
