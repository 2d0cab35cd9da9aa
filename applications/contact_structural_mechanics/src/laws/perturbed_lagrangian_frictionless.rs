//! Frictionless contact, perturbed Lagrangian, one multiplier a slave node along its normal.

use super::alm_frictionless::AlmFrictionless;
use crate::pairs::Family;
use crate::register_contact_family;

register_contact_family! { "PerturbedLagrangianContactFrictionless",
    about: "frictionless contact, perturbed Lagrangian, one multiplier a slave node along its normal",
    source: "Simo, Wriggers and Taylor (1985)",
    conditions: [
        "PerturbedLagrangianFrictionlessMortarContactCondition",
        "PerturbedLagrangianFrictionlessAxisymMortarContactCondition"
    ],
    build: Family {
        compliant: true,
        ..Family::of::<AlmFrictionless>(
            "PerturbedLagrangianFrictionlessMortarContactCondition",
            &[("NORMAL", 3), ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", 1), ("WEIGHTED_GAP", 1)],
        )
    },
}
