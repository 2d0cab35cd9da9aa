//! Friction by the penalty method, pair by pair: an elastic slip that the law of friction limits.
//!
//! Trial traction q = P R t° + κ ε s: the traction t° of the last accepted state, turned with the facet by R, and the weighted
//! slip s of the pair since then. Stick: t = q. Slip: t = b(ε g̃) τ, with b the bound of the law and τ the direction of the trial
//! traction of all pairs of the node; in space the tangent knows how it turns. An active node has the force p = f (ε g̃ n + t),
//! which acts through D and M.

use zelus_core::geometry::{FacetShape, NodeArray};
use zelus_core::scalar::Real;
use zelus_core::vector3::{add, scale};

use super::alm_frictional::AlmFrictional;
use super::penalty_by_node::PenaltyByNode;
use crate::active_set;
use crate::formulations::{
    Formulation, Kinematics, LastState, Multiplier, NodeState, PairResidual, SlaveNode, StepParameters,
};
use crate::pairs::{ByNode, Family, Friction};
use crate::register_contact_family;

/// Penalty method with friction, of weighted gaps and slips.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PenaltyFrictional {
    /// Ratio κ of tangential to normal penalty.
    pub tangent_factor: f64,
}

impl PenaltyFrictional {
    /// Trial tractions q of the slave nodes of a pair.
    pub fn trial<T: Real, S: FacetShape, M: FacetShape>(
        &self,
        pair: &Kinematics<T, S, M>,
        nodes: &S::Nodal<SlaveNode>,
        last: &LastState<S, M>,
    ) -> S::Nodal<[T; 3]> {
        let (carried, slip) = (last.carried(pair, nodes), last.slip(pair));
        S::nodal(|j| add(carried[j], scale(slip[j], T::constant(self.tangent_factor * nodes[j].penalty))))
    }
}

/// The direction τ of a sliding node; what it turns by with the trial traction of a pair is nothing but a derivative.
fn direction<T: Real>(node: &SlaveNode, trial: [T; 3]) -> [T; 3] {
    let change = trial.map(|q| (q - q.value()) * node.turning.by_slip);
    let along = change[0] * node.tangent[0] + change[1] * node.tangent[1] + change[2] * node.tangent[2];
    std::array::from_fn(|c| change[c] - along * node.tangent[c] + node.tangent[c])
}

impl Formulation for PenaltyFrictional {
    const MULTIPLIER: Multiplier = Multiplier::None;
    type History<S: FacetShape, M: FacetShape> = LastState<S, M>;

    fn new(parameters: &StepParameters) -> Self {
        Self { tangent_factor: parameters.tangent_factor }
    }

    fn weighted_slip<S: FacetShape, M: FacetShape>(
        &self,
        pair: &Kinematics<f64, S, M>,
        last: &LastState<S, M>,
    ) -> S::Nodal<[f64; 3]> {
        last.slip(pair)
    }

    fn weighted_trial<S: FacetShape, M: FacetShape>(
        &self,
        pair: &Kinematics<f64, S, M>,
        nodes: &S::Nodal<SlaveNode>,
        last: &LastState<S, M>,
    ) -> Option<S::Nodal<[f64; 3]>> {
        let trial = self.trial(pair, nodes, last);
        Some(S::nodal(|j| scale(trial[j], pair.area(j))))
    }

    fn residual<T: Real, S: FacetShape, M: FacetShape>(
        &self,
        pair: &Kinematics<T, S, M>,
        nodes: &S::Nodal<SlaveNode>,
        last: &LastState<S, M>,
    ) -> PairResidual<T, S, M> {
        let gap = pair.gap();
        let trial = self.trial(pair, nodes, last);
        let mut out = PairResidual::zero();
        for (j, node) in nodes.iter().enumerate() {
            let pressure = gap[j] * node.penalty;
            let traction = match node.state {
                NodeState::Inactive => continue,
                NodeState::Stick => trial[j],
                NodeState::Slip => scale(direction(node, trial[j]), node.friction.at(pressure)),
            };
            let force = add(scale(pair.normals[j], pressure), traction);
            out.add_nodal_force(&pair.operators, j, force.map(|p| p * node.dynamic_factor));
        }
        out
    }
}

/// Pair by pair.
const BY_PAIR: Family = Family {
    friction: Friction::Coulomb,
    decide: active_set::penalty_frictional,
    ..Family::of::<PenaltyFrictional>(
        "PenaltyFrictionalMortarContactCondition",
        &[
            ("NORMAL", 3),
            ("VECTOR_LAGRANGE_MULTIPLIER", 3),
            ("WEIGHTED_GAP", 1),
            ("WEIGHTED_SLIP", 3),
            ("FRICTION_TRACTION", 3),
        ],
    )
};

/// By node, with a multiplier a node and direction.
static IMPLICIT: Family = Family {
    friction: Friction::Coulomb,
    decide: active_set::alm_frictional,
    compliant: true,
    ..Family::of::<AlmFrictional>(BY_PAIR.condition, BY_PAIR.variables)
};

/// By node, in explicit steps.
static EXPLICIT: Family = Family {
    friction: Friction::Coulomb,
    decide: active_set::penalty_frictional,
    ..Family::of::<PenaltyByNode>(BY_PAIR.condition, BY_PAIR.variables)
};

register_contact_family! { "PenaltyContactFrictional",
    about: "Coulomb friction, penalty method",
    source: "eq. D.3",
    conditions: ["PenaltyFrictionalMortarContactCondition", "PenaltyFrictionalAxisymMortarContactCondition"],
    build: Family { by_node: Some(ByNode { implicit: &IMPLICIT, explicit: &EXPLICIT }), ..BY_PAIR },
}
