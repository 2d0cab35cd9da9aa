//! The forces of the supports.

use crate::assembly::{DofTable, Equations};
use crate::model::{ColumnOf, ModelPart, Rates};

/// The reactions of all unknowns that have one: minus the out-of-balance force, which supports and constraints carry.
///
/// With the equations, reactions also include the forces that constraints hand on to supports, so that they balance the loads. Free
/// nodes have the force of their constraints.
pub fn write_reactions(part: &mut ModelPart, dofs: &DofTable, residual: &[f64], handed_on: Option<&Equations>) {
    const TAKEN_UP: ColumnOf = |rates| rates.reaction;
    let minus: Vec<f64> = match handed_on {
        Some(equations) => equations.reactions(residual),
        None => residual.iter().map(|r| -r).collect(),
    };
    Rates::add(&mut part.nodes.history, &[TAKEN_UP]);
    dofs.write_column(part, TAKEN_UP, 0, &minus);
}
