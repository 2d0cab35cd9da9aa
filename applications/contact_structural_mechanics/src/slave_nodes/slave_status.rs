//! Status of slave nodes as a column, by which criteria tell the parts of their equations apart.

use zelus_core::model::{ModelPart, SlaveNodes};
use zelus_structural_mechanics::variables::NORMAL;

use super::slave_states::SlaveStates;
use crate::law::NodeState;
use crate::variables::{MULTIPLIER_WEIGHT, SLAVE_STATUS};

/// Whether a slave node is in contact, and which law of friction acts there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SlaveStatus {
    /// Not in contact.
    Inactive,
    /// In contact, and without friction.
    Frictionless,
    /// In contact, and held by friction.
    Stick,
    /// In contact, and sliding against friction.
    Slip,
}

impl SlaveStatus {
    /// The status of a slave node of a model part, by its index.
    pub fn at(slave_nodes: &SlaveNodes, at: usize) -> Self {
        match slave_nodes.history.values(&SLAVE_STATUS, 0).get(at) {
            Some(1.0) => Self::Frictionless,
            Some(2.0) => Self::Stick,
            Some(3.0) => Self::Slip,
            _ => Self::Inactive,
        }
    }

    fn number(self) -> f64 {
        f64::from(self as u8)
    }
}

/// Writes the columns of slave nodes that criteria of friction read.
pub(crate) fn write_status(part: &mut ModelPart, states: &SlaveStates) {
    let history = &mut part.slave_nodes.history;
    let status = |slave| match states[slave].contact() {
        NodeState::Inactive => SlaveStatus::Inactive,
        _ if states[slave].parameters.friction.is_smooth() => SlaveStatus::Frictionless,
        NodeState::Stick => SlaveStatus::Stick,
        NodeState::Slip => SlaveStatus::Slip,
    };
    for slave in states.all() {
        let at = states.owner(slave) as usize;
        history.values_mut(&SLAVE_STATUS, 0)[at] = status(slave).number();
        history.values_mut(&MULTIPLIER_WEIGHT, 0)[at] = states[slave].law.multiplier_weight;
        history.values_mut(&NORMAL, 0)[3 * at..3 * at + 3].copy_from_slice(&states[slave].kinematics.normal);
    }
}
