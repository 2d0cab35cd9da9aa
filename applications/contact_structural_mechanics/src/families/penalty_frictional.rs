//! Coulomb friction by the penalty method.

use zelus_core::register;
use zelus_core::registry::Build;

use super::shapes::{self, register_shapes};
use crate::formulations::{Kinematics, LastState, PenaltyFrictional, SlaveNode};
use crate::interaction::StepParameters;
use crate::mortar::PairGeometry;
use crate::pairs::{Family, Friction, Multiplier, Pair, PairFormulation};

impl PairFormulation for PenaltyFrictional {
    fn new(parameters: &StepParameters) -> Self {
        Self { tangent_factor: parameters.tangent_factor, weighted: parameters.weighted_penalty }
    }

    fn multiplier() -> Multiplier {
        Multiplier::None
    }

    fn history<const NS: usize, const NM: usize>(_: &Pair, last: &PairGeometry<f64, NS, NM>) -> LastState<NS, NM> {
        LastState { slave: last.slave, master: last.master }
    }

    fn slip<const NS: usize, const NM: usize>(
        &self,
        pair: &Kinematics<f64, NS, NM>,
        last: &LastState<NS, NM>,
    ) -> [[f64; 3]; NS] {
        Self::slip(pair, last)
    }

    fn trial<const NS: usize, const NM: usize>(
        &self,
        pair: &Kinematics<f64, NS, NM>,
        nodes: &[SlaveNode; NS],
        last: &LastState<NS, NM>,
    ) -> Option<[[f64; 3]; NS]> {
        Some(Self::trial(self, pair, nodes, last))
    }
}

register! { Condition "PenaltyContactFrictional",
    about: "Coulomb friction, penalty method",
    source: "eq. D.3",
    build: Build::Factory(&Family {
        condition: "PenaltyFrictionalMortarContactCondition",
        multiplier: Multiplier::None,
        variables: &[("NORMAL", 3), ("WEIGHTED_GAP", 1), ("WEIGHTED_SLIP", 3), ("FRICTION_TRACTION", 3)],
        friction: Friction::Coulomb,
        penalty: true,
        weighted_gaps: false,
        block: shapes::block::<PenaltyFrictional>,
    }),
}
register_shapes!(
    "PenaltyFrictionalMortarContactCondition",
    "PenaltyFrictionalAxisymMortarContactCondition2D2N",
    "pair of the family PenaltyContactFrictional"
);
