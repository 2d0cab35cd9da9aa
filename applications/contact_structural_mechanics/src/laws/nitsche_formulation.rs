//! Contact by Nitsche's method, without friction and with it; its forces are stated in [`crate::law::nitsche`].

use crate::law::{Multiplier, rules};
use crate::pairs::{Formulation, Friction, nitsche_block};
use crate::register_contact_formulation;

register_contact_formulation! { "NitscheContactFrictionless",
    about: "frictionless contact by Nitsche's method: tractions of the slave's elements, no multipliers",
    source: "Chouly, Hild and Renard (2015)",
    conditions: ["NitscheFrictionlessMortarContactCondition", "NitscheFrictionlessAxisymMortarContactCondition"],
    build: Formulation::with_blocks(
        "NitscheFrictionlessMortarContactCondition",
        &[("NORMAL", 3), ("WEIGHTED_GAP", 1)],
        Multiplier::Body,
        |node, _| rules::of_points(node),
        |request| nitsche_block(request, false),
    ),
}
register_contact_formulation! { "NitscheContactFrictional",
    about: "Coulomb friction by Nitsche's method: tractions of the slave's elements, no multipliers",
    source: "Chouly, Hild and Renard (2015)",
    conditions: ["NitscheFrictionalMortarContactCondition", "NitscheFrictionalAxisymMortarContactCondition"],
    build: Formulation {
        friction: Friction::Coulomb,
        ..Formulation::with_blocks(
            "NitscheFrictionalMortarContactCondition",
            &[("NORMAL", 3), ("WEIGHTED_GAP", 1), ("WEIGHTED_SLIP", 3), ("CARRIED_TRACTION", 3)],
            Multiplier::Body,
            |node, _| rules::of_points(node),
            |request| nitsche_block(request, true),
        )
    },
}
