//! Frictionless contact by the augmented Lagrangian with a multiplier a direction.

use crate::pairs::FamilyEntry;
use zelus_core::register;

use super::shapes::{self, register_shapes};
use crate::formulations::AlmFrictionlessComponents;
use crate::interaction::StepParameters;
use crate::mortar::PairGeometry;
use crate::pairs::{Family, Friction, Multiplier, Pair, PairFormulation};
use crate::variables::VECTOR_LAGRANGE_MULTIPLIER;

impl PairFormulation for AlmFrictionlessComponents {
    fn new(parameters: &StepParameters) -> Self {
        Self { scale_factor: parameters.scale_factor, augmentation: parameters.augmentation }
    }

    fn multiplier() -> Multiplier {
        Multiplier::Vector(&VECTOR_LAGRANGE_MULTIPLIER)
    }

    fn history<const NS: usize, const NM: usize>(_: &Pair, _: &PairGeometry<f64, NS, NM>) {}
}

register! { FamilyEntry "ALMContactFrictionlessComponents",
    about: "frictionless contact, augmented Lagrangian, one multiplier a slave node and direction",
    source: "eq. 4.9, D.11 by components",
    build: Family {
        condition: "ALMFrictionlessComponentsMortarContactCondition",
        multiplier: Multiplier::Vector(&VECTOR_LAGRANGE_MULTIPLIER),
        variables: &[("NORMAL", 3), ("VECTOR_LAGRANGE_MULTIPLIER", 3), ("WEIGHTED_GAP", 1), ("WEIGHTED_VECTOR_RESIDUAL", 3)],
        friction: Friction::None,
        penalty: false,
        weighted_gaps: true,
        compliant: false,
        updated: false,
        by_node: None,
        block: shapes::block::<AlmFrictionlessComponents>,
    },
}
register_shapes!(
    "ALMFrictionlessComponentsMortarContactCondition",
    "ALMFrictionlessComponentsAxisymMortarContactCondition2D2N",
    "pair of the family ALMContactFrictionlessComponents"
);
