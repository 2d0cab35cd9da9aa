//! Frictionless contact, perturbed Lagrangian, one multiplier a slave node along its normal.

use crate::pairs::FamilyEntry;
use zelus_core::register;

use super::shapes::{self, register_shapes};
use crate::formulations::AlmFrictionless;
use crate::pairs::{Family, Friction, Multiplier};
use crate::variables::LAGRANGE_MULTIPLIER_CONTACT_PRESSURE;

register! { FamilyEntry "PerturbedLagrangianContactFrictionless",
    about: "frictionless contact, perturbed Lagrangian, one multiplier a slave node along its normal",
    source: "Simo, Wriggers and Taylor (1985)",
    build: Family {
        condition: "PerturbedLagrangianFrictionlessMortarContactCondition",
        multiplier: Multiplier::Scalar(&LAGRANGE_MULTIPLIER_CONTACT_PRESSURE),
        variables: &[("NORMAL", 3), ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", 1), ("WEIGHTED_GAP", 1)],
        friction: Friction::None,
        penalty: false,
        weighted_gaps: false,
        compliant: true,
        updated: false,
        by_node: None,
        block: shapes::block::<AlmFrictionless>,
    },
}
register_shapes!(
    "PerturbedLagrangianFrictionlessMortarContactCondition",
    "PerturbedLagrangianFrictionlessAxisymMortarContactCondition2D2N",
    "pair of the family PerturbedLagrangianContactFrictionless"
);
