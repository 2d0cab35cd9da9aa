//! The forces of the supports.

use crate::assembly::{DofTable, Equations};
use crate::model::{ModelPart, variables};

/// REACTION of every displacement: minus the out-of-balance force, which supports and constraints carry.
///
/// With the equations, supports also bear what constraints hand on to them, so that their forces balance the loads. Free nodes
/// have the force of their constraints.
pub(super) fn write_reactions(part: &mut ModelPart, dofs: &DofTable, residual: &[f64], handed_on: Option<&Equations>) {
    let supported = handed_on.map(|equations| equations.supported(residual));
    let residual = supported.as_deref().unwrap_or(residual);
    let reaction = part.nodes.history.values_mut(&variables::REACTION, 0);
    for (dof, r) in dofs.dofs().iter().zip(residual) {
        if dof.variable.column == variables::DISPLACEMENT.name() {
            reaction[3 * dof.node as usize + dof.variable.offset()] = -r;
        }
    }
}
