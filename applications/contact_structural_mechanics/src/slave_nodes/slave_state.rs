//! The state of a slave node.

use serde::{Deserialize, Serialize};

use crate::law::{Bound, DirectionRotation, MultiplierConstraints, NodeState, SoftTangent, StepParameters};

/// One slave node.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct SlaveState {
    /// Its normal, and the sums over its pairs.
    pub kinematics: SlaveKinematics,
    /// Its contact state with tractions and directions.
    pub law: SlaveLawState,
    /// Its penalty and its friction.
    pub parameters: SlaveParameters,
    /// Its state that was accepted last.
    pub last: Accepted,
}

/// Kinematics of a slave node in the present configuration.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct SlaveKinematics {
    /// Whether it faces nothing that could bear on it.
    pub isolated: bool,
    /// Unit normal out of the slave body.
    pub normal: [f64; 3],
    /// Whether that is the normal of the opposite master, and does not rotate with its own facets: nodes on sharp edges.
    pub normal_of_master: bool,
    /// Pairs that overlap at it.
    pub pairs: u32,
    /// Area that belongs to it, over its pairs.
    pub area: f64,
    /// Weighted gap g̃ over its pairs, negative in penetration (length times area).
    pub weighted_gap: f64,
    /// Weighted gaps of its pairs, averaged by their areas (length times area).
    pub mean_weighted_gap: f64,
    /// Weighted slip of the step over its pairs (length times area).
    pub weighted_slip: [f64; 3],
    /// Gap with which it began the step near the master, else 0 (length).
    pub start_gap: f64,
    /// Gap with which it began the step; 0 where nothing overlapped (length).
    pub gap_at_start: f64,
}

/// State of the contact law at a slave node: active set, sliding, tractions.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct SlaveLawState {
    /// Whether it is in contact.
    pub active: bool,
    /// Whether it was in contact at the end of the last accepted step, or touched its master when the step began.
    pub joined: bool,
    /// Whether it slides, while it is in contact or was last; `None` before.
    pub slides: Option<bool>,
    /// Tangential traction before the law of friction limits it; where points decide, their mean traction (force per area).
    pub trial: [f64; 3],
    /// Tangential history traction, in formulations that have one (force per area).
    pub history_traction: [f64; 3],
    /// Normal pressure that Uzawa's iteration keeps between updates, negative in compression (force per area).
    pub uzawa_pressure: f64,
    /// How supports hold each component of its multiplier; of a scalar one the first.
    pub constraints: MultiplierConstraints,
    /// Weight of its multiplier's equation where that states a traction (force times area).
    pub multiplier_weight: f64,
    /// Unit tangent τ: the direction of sliding.
    pub tangent: [f64; 3],
    /// How that direction rotates with the unknowns.
    pub rotation: DirectionRotation,
    /// Whether points around it are in contact until the next solve, whatever their pressure.
    pub forced_active: bool,
    /// Whether points in contact around it stick until the next solve, whatever their traction.
    pub forced_stick: bool,
    /// Normal traction for output, compression negative.
    pub pressure: f64,
    /// Tangential traction for output.
    pub traction: [f64; 3],
}

/// Parameters of the contact law at a slave node.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct SlaveParameters {
    /// Penalty ε.
    pub penalty: f64,
    /// Factor of contact forces in the step in which a gap closes.
    pub dynamic_factor: f64,
    /// Limit of the tangential traction.
    pub friction: Bound,
    /// Temperature of contact; 0 where the law of friction does not ask for it.
    #[serde(default)]
    pub temperature: f64,
    /// Soft contact at its present pressure, where the deck has a law of it.
    pub soft: Option<SoftTangent>,
    /// Whether contact does not open again (`no_separation`).
    pub no_separation: bool,
}

/// The part of a slave node that is compared with its last accepted state.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Accepted {
    /// Weighted gap.
    pub weighted_gap: f64,
    /// History traction.
    pub history_traction: [f64; 3],
}

impl SlaveState {
    /// Whether the node is in contact, and how.
    pub fn contact(&self) -> NodeState {
        match (self.law.active, self.law.slides) {
            (false, _) => NodeState::Inactive,
            (true, Some(true)) => NodeState::Slip,
            (true, _) => NodeState::Stick,
        }
    }

    /// Whether it stays in contact, once it has been in it, whatever its pressure.
    pub fn stays(&self) -> bool {
        self.parameters.no_separation && self.law.joined
    }

    /// Gap g̃/A (length); `None` where nothing overlaps.
    pub fn gap(&self) -> Option<f64> {
        (self.kinematics.area > 0.0).then(|| self.kinematics.weighted_gap / self.kinematics.area)
    }

    /// Weighted gap that the pressure of the node counts. Where a penalty counts weighted gaps each pair acts by its own, and
    /// their mean acts on the node.
    pub fn counted_gap(&self, parameters: &StepParameters) -> f64 {
        if parameters.weighted_penalty { self.kinematics.mean_weighted_gap } else { self.kinematics.weighted_gap }
    }

    /// k² A/c: the weight of the equation of the node's multiplier where that states a traction (force times area).
    pub fn equation_weight(&self, parameters: &StepParameters) -> f64 {
        parameters.scale_factor.powi(2) * self.kinematics.area
            / parameters.nodal_stiffness(self.parameters.penalty, self.kinematics.area)
    }
}
