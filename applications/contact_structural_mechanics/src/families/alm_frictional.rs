//! Coulomb friction by the augmented Lagrangian with a multiplier a direction.

use crate::pairs::FamilyEntry;
use zelus_core::register;

use super::shapes::{self, register_shapes};
use crate::formulations::{AlmFrictional, Kinematics, SlaveNode, SlipHistory};
use crate::interaction::StepParameters;
use crate::mortar::PairGeometry;
use crate::pairs::{Family, Friction, Multiplier, Pair, PairFormulation};
use crate::variables::VECTOR_LAGRANGE_MULTIPLIER;

impl PairFormulation for AlmFrictional {
    fn new(parameters: &StepParameters) -> Self {
        Self {
            scale_factor: parameters.scale_factor,
            tangent_factor: parameters.tangent_factor,
            operator_threshold: parameters.operator_threshold,
            augmentation: parameters.augmentation,
            compliant: parameters.compliant,
            dynamic: parameters.dynamic,
        }
    }

    fn multiplier() -> Multiplier {
        Multiplier::Vector(&VECTOR_LAGRANGE_MULTIPLIER)
    }

    fn history<const NS: usize, const NM: usize>(
        pair: &Pair,
        previous: &PairGeometry<f64, NS, NM>,
    ) -> SlipHistory<NS, NM> {
        SlipHistory {
            previous: pair.previous.operators(),
            reference_slave: previous.slave,
            reference_master: previous.master,
        }
    }

    fn slip<const NS: usize, const NM: usize>(
        &self,
        pair: &Kinematics<f64, NS, NM>,
        history: &SlipHistory<NS, NM>,
    ) -> [[f64; 3]; NS] {
        AlmFrictional::slip(self, pair, history)
    }

    fn trial<const NS: usize, const NM: usize>(
        &self,
        pair: &Kinematics<f64, NS, NM>,
        nodes: &[SlaveNode; NS],
        history: &SlipHistory<NS, NM>,
    ) -> Option<[[f64; 3]; NS]> {
        self.compliant.then(|| AlmFrictional::trial(self, pair, nodes, history))
    }
}

/// The family, with or without sticking.
pub(super) const fn family(friction: Friction) -> Family {
    Family {
        condition: "ALMFrictionalMortarContactCondition",
        multiplier: Multiplier::Vector(&VECTOR_LAGRANGE_MULTIPLIER),
        variables: &[
            ("NORMAL", 3),
            ("VECTOR_LAGRANGE_MULTIPLIER", 3),
            ("WEIGHTED_GAP", 1),
            ("WEIGHTED_SLIP", 3),
            ("WEIGHTED_VECTOR_RESIDUAL", 3),
        ],
        friction,
        penalty: false,
        weighted_gaps: true,
        compliant: false,
        updated: false,
        by_node: None,
        block: shapes::block::<AlmFrictional>,
    }
}

register! { FamilyEntry "ALMContactFrictional",
    about: "Coulomb friction, augmented Lagrangian, one multiplier a slave node and direction",
    source: "eq. 4.9, D.11, D.13",
    build: family(Friction::Coulomb),
}
register_shapes!(
    "ALMFrictionalMortarContactCondition",
    "ALMFrictionalAxisymMortarContactCondition2D2N",
    "pair of the families ALMContactFrictional and ALMContactFrictionalPureSlip"
);
