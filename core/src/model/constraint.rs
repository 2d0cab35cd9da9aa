//! Linear relations between unknowns, removed from the system by elimination (eqs. D.12a–e).

use serde::{Deserialize, Serialize};

use super::directional_support::DirectionalSupport;
use super::variable::ScalarVariable;

/// An unknown of a node.
pub type NodeUnknown = (u32, ScalarVariable);

/// u_slave = Σ weight · u_master + constant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MasterSlaveConstraint {
    /// Number in the mesh.
    pub id: usize,
    /// The eliminated unknown: node index and variable.
    pub slave: NodeUnknown,
    /// The unknowns it follows, with weights.
    pub masters: Vec<(NodeUnknown, f64)>,
    /// How much of the slave's force each master takes where that is not its weight, as where friction goes with the
    /// constraint's force.
    pub forces: Option<Vec<f64>>,
    /// Constant c of u_slave = Σ w u_master + c.
    pub constant: f64,
    /// Whether it holds now.
    pub active: bool,
    /// The set of slave nodes that own its unknowns, each at the mesh node named; `None` for unknowns of mesh nodes.
    pub set: Option<String>,
    /// The support along a direction from which it comes: its force acts between the node and the ground.
    pub support: Option<DirectionalSupport>,
    /// The process that made it and its part, for messages; empty for constraints of the mesh.
    pub origin: String,
}

impl MasterSlaveConstraint {
    /// A constraint that holds, without a constant, and not yet of a part: its id is 0.
    pub fn new(slave: NodeUnknown, masters: Vec<(NodeUnknown, f64)>) -> Self {
        Self {
            id: 0,
            slave,
            masters,
            forces: None,
            constant: 0.0,
            active: true,
            set: None,
            support: None,
            origin: String::new(),
        }
    }

    /// Its number, and where it comes from, for messages.
    pub fn in_words(&self) -> String {
        match self.origin.as_str() {
            "" => format!("constraint {}", self.id),
            origin => format!("constraint {} of {origin}", self.id),
        }
    }
}
