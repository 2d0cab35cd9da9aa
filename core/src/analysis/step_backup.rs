//! The state to which a step goes back that did not converge.

use crate::assembly::System;
use crate::model::{Fields, Flags, MasterSlaveConstraint, ModelPart, NodalState, ProcessInfo};

/// State that a retried step restores: all that processes and the solution of a step change.
pub(super) struct StepBackup {
    nodal: NodalState,
    elements: (Fields, Flags),
    conditions: (Fields, Flags),
    constraints: Vec<MasterSlaveConstraint>,
    info: ProcessInfo,
}

impl StepBackup {
    /// The present state.
    pub(super) fn of(part: &ModelPart, system: &mut System) -> Self {
        system.interactions.iter_mut().filter_map(|i| i.retry()).for_each(|own| own.save());
        Self {
            nodal: part.nodal_state(),
            elements: (part.elements.data.clone(), part.elements.flags.clone()),
            conditions: (part.conditions.data.clone(), part.conditions.flags.clone()),
            constraints: part.constraints.clone(),
            info: part.info.clone(),
        }
    }

    /// Puts the state back.
    pub(super) fn restore(self, part: &mut ModelPart, system: &mut System) {
        part.restore(self.nodal);
        (part.elements.data, part.elements.flags) = self.elements;
        (part.conditions.data, part.conditions.flags) = self.conditions;
        part.elements.finish();
        part.conditions.finish();
        part.constraints = self.constraints;
        part.info = self.info;
        system.interactions.iter_mut().filter_map(|i| i.retry()).for_each(|own| own.restore());
    }
}
