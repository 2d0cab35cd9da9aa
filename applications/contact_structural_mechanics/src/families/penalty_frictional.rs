//! Coulomb friction by the penalty method.

use crate::pairs::FamilyEntry;
use zelus_core::register;

use super::shapes::{self, register_shapes};
use crate::formulations::{AlmFrictional, Kinematics, LastState, PenaltyByNode, PenaltyFrictional, SlaveNode};
use crate::interaction::StepParameters;
use crate::mortar::PairGeometry;
use crate::pairs::{ByNode, Family, Friction, Multiplier, Pair, PairFormulation};
use crate::variables::VECTOR_LAGRANGE_MULTIPLIER;
use zelus_core::vector3::scale;

impl PairFormulation for PenaltyFrictional {
    fn new(parameters: &StepParameters) -> Self {
        Self { tangent_factor: parameters.tangent_factor }
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
        let trial = Self::trial(self, pair, nodes, last);
        Some(std::array::from_fn(|j| scale(trial[j], pair.area(j))))
    }
}

impl PairFormulation for PenaltyByNode {
    fn new(parameters: &StepParameters) -> Self {
        Self { tangent_factor: parameters.tangent_factor }
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
        PenaltyFrictional::slip(pair, last)
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

/// Pair by pair.
const BY_PAIR: Family = Family {
    condition: "PenaltyFrictionalMortarContactCondition",
    multiplier: Multiplier::None,
    variables: &[
        ("NORMAL", 3),
        ("VECTOR_LAGRANGE_MULTIPLIER", 3),
        ("WEIGHTED_GAP", 1),
        ("WEIGHTED_SLIP", 3),
        ("FRICTION_TRACTION", 3),
    ],
    friction: Friction::Coulomb,
    penalty: true,
    weighted_gaps: false,
    compliant: false,
    updated: false,
    by_node: None,
    block: shapes::block::<PenaltyFrictional>,
};

/// By node, with a multiplier a node and direction.
static IMPLICIT: Family = Family {
    multiplier: Multiplier::Vector(&VECTOR_LAGRANGE_MULTIPLIER),
    penalty: false,
    compliant: true,
    block: shapes::block::<AlmFrictional>,
    ..BY_PAIR
};

/// By node, in explicit steps.
static EXPLICIT: Family = Family { block: shapes::block::<PenaltyByNode>, ..BY_PAIR };

register! { FamilyEntry "PenaltyContactFrictional",
    about: "Coulomb friction, penalty method",
    source: "eq. D.3",
    build: Family { by_node: Some(ByNode { implicit: &IMPLICIT, explicit: &EXPLICIT }), ..BY_PAIR },
}
register_shapes!(
    "PenaltyFrictionalMortarContactCondition",
    "PenaltyFrictionalAxisymMortarContactCondition2D2N",
    "pair of the family PenaltyContactFrictional"
);
