//! The forces of the supports.

use crate::model::{ModelPart, variables};

/// REACTION of every displacement: minus the out-of-balance force, which supports and constraints carry.
pub(super) fn write_reactions(part: &mut ModelPart, residual: &[f64]) {
    let dofs = std::mem::take(&mut part.dofs);
    let reaction = part.nodes.history.values_mut(&variables::REACTION, 0);
    for (dof, r) in dofs.dofs().iter().zip(residual) {
        if dof.variable.column == variables::DISPLACEMENT.name() {
            reaction[3 * dof.node as usize + dof.variable.offset()] = -r;
        }
    }
    part.dofs = dofs;
}
