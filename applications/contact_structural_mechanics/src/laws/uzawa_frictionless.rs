//! Frictionless contact by Uzawa's iteration: a perturbed Lagrangian whose penetration an outer loop takes away.

use super::alm_frictionless::AlmFrictionless;
use crate::pairs::Formulation;
use crate::register_contact_formulation;

register_contact_formulation! { "UzawaContactFrictionless",
    about: "frictionless contact, perturbed Lagrangian whose penetration an outer loop of multiplier updates takes away",
    source: "eq. D.10",
    conditions: ["UzawaFrictionlessMortarContactCondition", "UzawaFrictionlessAxisymMortarContactCondition"],
    build: Formulation {
        regularised: true,
        updated: true,
        ..Formulation::of::<AlmFrictionless>(
            "UzawaFrictionlessMortarContactCondition",
            &[("NORMAL", 3), ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", 1), ("KEPT_CONTACT_PRESSURE", 1), ("WEIGHTED_GAP", 1)],
        )
    },
}
