//! Frictionless contact by Nitsche's method.

use crate::pairs::FamilyEntry;
use zelus_core::register;

use super::shapes::{nitsche_block, register_shapes};
use crate::formulations::{Kinematics, LastState, Nitsche};
use crate::interaction::StepParameters;
use crate::mortar::PairGeometry;
use crate::pairs::{Family, Friction, Multiplier, Pair, PairFormulation};

impl PairFormulation for Nitsche {
    fn new(parameters: &StepParameters) -> Self {
        parameters.nitsche
    }

    fn multiplier() -> Multiplier {
        Multiplier::Body
    }

    fn history<const NS: usize, const NM: usize>(_: &Pair, last: &PairGeometry<f64, NS, NM>) -> LastState<NS, NM> {
        LastState { slave: last.slave, master: last.master }
    }

    fn slip<const NS: usize, const NM: usize>(
        &self,
        pair: &Kinematics<f64, NS, NM>,
        last: &LastState<NS, NM>,
    ) -> [[f64; 3]; NS] {
        Nitsche::slip(self, pair, last)
    }
}

register! { FamilyEntry "NitscheContactFrictionless",
    about: "frictionless contact by Nitsche's method: tractions of the slave's elements, no multipliers",
    source: "Chouly, Hild and Renard (2015)",
    build: Family {
        condition: "NitscheFrictionlessMortarContactCondition",
        multiplier: Multiplier::Body,
        variables: &[("NORMAL", 3), ("WEIGHTED_GAP", 1)],
        friction: Friction::None,
        penalty: false,
        compliant: false,
        updated: false,
        by_node: None,
        weighted_gaps: false,
        block: |slave, master, request| nitsche_block(slave, master, request, false),
    },
}
register_shapes!(
    "NitscheFrictionlessMortarContactCondition",
    "NitscheFrictionlessAxisymMortarContactCondition2D2N",
    "pair of the family NitscheContactFrictionless"
);
