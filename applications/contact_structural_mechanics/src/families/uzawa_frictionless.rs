//! Frictionless contact by Uzawa's iteration: a perturbed Lagrangian whose penetration an outer loop takes away.

use crate::pairs::FamilyEntry;
use zelus_core::register;

use super::shapes::{self, register_shapes};
use crate::formulations::AlmFrictionless;
use crate::pairs::{Family, Friction, Multiplier};
use crate::variables::LAGRANGE_MULTIPLIER_CONTACT_PRESSURE;

register! { FamilyEntry "UzawaContactFrictionless",
    about: "frictionless contact, perturbed Lagrangian whose penetration an outer loop of multiplier updates takes away",
    source: "eq. D.10",
    build: Family {
        condition: "UzawaFrictionlessMortarContactCondition",
        multiplier: Multiplier::Scalar(&LAGRANGE_MULTIPLIER_CONTACT_PRESSURE),
        variables: &[
            ("NORMAL", 3),
            ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", 1),
            ("KEPT_CONTACT_PRESSURE", 1),
            ("WEIGHTED_GAP", 1),
        ],
        friction: Friction::None,
        penalty: false,
        weighted_gaps: false,
        compliant: true,
        updated: true,
        by_node: None,
        block: shapes::block::<AlmFrictionless>,
    },
}
register_shapes!(
    "UzawaFrictionlessMortarContactCondition",
    "UzawaFrictionlessAxisymMortarContactCondition2D2N",
    "pair of the family UzawaContactFrictionless"
);
