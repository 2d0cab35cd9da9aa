//! Constants of a slave node during an assembly.

use super::bond::BondTangent;
use super::friction_law::Bound;
use super::node_state::{DirectionRotation, MultiplierConstraints, NodeState};

/// Constants of a slave node during an assembly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlaveNode {
    /// Decided by the active-set update, never here.
    pub state: NodeState,
    /// Penalty ε > 0.
    pub penalty: f64,
    /// 1/ε of regularised formulations, penetration by pressure; 0 of all others.
    pub compliance: f64,
    /// Pressure p° of regularised formulations, compression negative: that of Uzawa's iteration, or at which the tangent of soft contact has
    /// no depth; else 0.
    pub uzawa_pressure: f64,
    /// c > 0: stiffness by length, for rows that state tractions beside others that state gaps and slips.
    pub stiffness: f64,
    /// A > 0: the area that this pair has of the node, or all pairs where they augment; constant in the tangent.
    pub area: f64,
    /// Factor f on nodal forces, 1 unless the dynamic factor is in use.
    pub dynamic_factor: f64,
    /// Limit of the tangential traction.
    pub friction: Bound,
    /// Unit tangent τ: the direction of sliding.
    pub tangent: [f64; 3],
    /// Derivative of that direction by the unknowns.
    pub rotation: DirectionRotation,
    /// Constraint on each component of its multiplier; of a scalar one the first.
    pub constraints: MultiplierConstraints,
    /// k² A/c: the weight of the equations of constrained components.
    pub constraint_weight: f64,
    /// Tangential traction t° of the last accepted state, where a law has a history traction (force per area).
    pub history_traction: [f64; 3],
    /// Tangential opening w_t° of a bond in the last accepted state (length).
    pub history_sliding: [f64; 3],
    /// Its bond, where the deck has a law of bonds.
    pub bond: Option<BondTangent>,
    /// Traction of all pairs of the node, where a law computes it before its pairs (force per area).
    pub traction: [f64; 3],
}
