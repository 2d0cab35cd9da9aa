//! Frictionless contact by Uzawa's iteration: a perturbed Lagrangian whose penetration an outer loop takes away.

use super::alm_frictionless::AlmFrictionless;
use crate::pairs::Family;
use crate::register_contact_family;

register_contact_family! { "UzawaContactFrictionless",
    about: "frictionless contact, perturbed Lagrangian whose penetration an outer loop of multiplier updates takes away",
    source: "eq. D.10",
    conditions: ["UzawaFrictionlessMortarContactCondition", "UzawaFrictionlessAxisymMortarContactCondition"],
    build: Family {
        compliant: true,
        updated: true,
        ..Family::of::<AlmFrictionless>(
            "UzawaFrictionlessMortarContactCondition",
            &[("NORMAL", 3), ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", 1), ("KEPT_CONTACT_PRESSURE", 1), ("WEIGHTED_GAP", 1)],
        )
    },
}
