//! Coulomb friction by the penalty method.

use zelus_core::register;
use zelus_core::registry::Build;

use super::shapes::{self, register_shapes};
use crate::formulations::PenaltyFrictional;
use crate::interaction::StepParameters;
use crate::mortar::{Operators, PairGeometry, objective_slip};
use crate::pairs::{Family, Friction, Multiplier, Pair, PairFormulation};

impl PairFormulation for PenaltyFrictional {
    fn new(parameters: &StepParameters) -> Self {
        Self { tangent_factor: parameters.tangent_factor }
    }

    fn multiplier() -> Multiplier {
        Multiplier::None
    }

    fn history<const NS: usize, const NM: usize>(pair: &Pair, _: &PairGeometry<f64, NS, NM>) -> Operators<f64, NS, NM> {
        pair.previous.operators()
    }

    fn slip<const NS: usize, const NM: usize>(
        &self,
        operators: &Operators<f64, NS, NM>,
        geometry: &PairGeometry<f64, NS, NM>,
        previous: &Operators<f64, NS, NM>,
    ) -> [[f64; 3]; NS] {
        objective_slip(operators, previous, &geometry.slave, &geometry.master, &geometry.nodal_normals)
    }
}

register! { Condition "PenaltyContactFrictional",
    about: "Coulomb friction, penalty method",
    source: "eq. D.3",
    build: Build::Factory(&Family {
        condition: "PenaltyFrictionalMortarContactCondition",
        multiplier: Multiplier::None,
        variables: &[("NORMAL", 3), ("WEIGHTED_GAP", 1), ("WEIGHTED_SLIP", 3)],
        friction: Friction::Coulomb,
        penalty: true,
        weighted_gaps: true,
        block: shapes::block::<PenaltyFrictional>,
    }),
}
register_shapes!(
    "PenaltyFrictionalMortarContactCondition",
    "PenaltyFrictionalAxisymMortarContactCondition2D2N",
    "pair of the family PenaltyContactFrictional"
);
