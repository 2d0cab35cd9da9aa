//! Contact with friction by Nitsche's method.

use crate::pairs::FamilyEntry;
use zelus_core::register;

use super::shapes::{nitsche_block, register_shapes};
use crate::pairs::{Family, Friction, Multiplier};

register! { FamilyEntry "NitscheContactFrictional",
    about: "Coulomb friction by Nitsche's method: tractions of the slave's elements, no multipliers",
    source: "Chouly, Hild and Renard (2015)",
    build: Family {
        condition: "NitscheFrictionalMortarContactCondition",
        multiplier: Multiplier::Body,
        variables: &[("NORMAL", 3), ("WEIGHTED_GAP", 1), ("WEIGHTED_SLIP", 3), ("CARRIED_TRACTION", 3)],
        friction: Friction::Coulomb,
        penalty: false,
        compliant: false,
        updated: false,
        by_node: None,
        weighted_gaps: false,
        block: |slave, master, request| nitsche_block(slave, master, request, true),
    },
}
register_shapes!(
    "NitscheFrictionalMortarContactCondition",
    "NitscheFrictionalAxisymMortarContactCondition2D2N",
    "pair of the family NitscheContactFrictional"
);
