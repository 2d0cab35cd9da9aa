//! Frictionless contact, perturbed Lagrangian, one multiplier a slave node along its normal.

use super::alm_frictionless::AlmFrictionless;
use crate::pairs::Formulation;
use crate::register_contact_formulation;

register_contact_formulation! { "PerturbedLagrangianContactFrictionless",
    about: "frictionless contact, perturbed Lagrangian, one multiplier a slave node along its normal",
    source: "Simo, Wriggers and Taylor (1985)",
    conditions: [
        "PerturbedLagrangianFrictionlessMortarContactCondition",
        "PerturbedLagrangianFrictionlessAxisymMortarContactCondition"
    ],
    build: Formulation {
        regularised: true,
        ..Formulation::of::<AlmFrictionless>(
            "PerturbedLagrangianFrictionlessMortarContactCondition",
            &[("NORMAL", 3), ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", 1), ("WEIGHTED_GAP", 1)],
        )
    },
}
