//! Properties of the elements and conditions of all ranks that decide how their tangent is kept.

use crate::assembly::System;
use crate::entities::{EntityBlock, Tangent};
use crate::model::ModelPart;

/// Properties of the blocks of all ranks.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct BulkTraits {
    /// Elements whose tangent depends on the state.
    pub variable_elements: bool,
    /// Elements whose tangent is not symmetric.
    pub general_elements: bool,
    /// Elements, or conditions other than follower loads, whose tangent depends on the state.
    pub variable_bulk: bool,
}

impl BulkTraits {
    /// The properties of the blocks of `system`; collective.
    pub fn of(part: &ModelPart, system: &System) -> Self {
        let variable_elements = system.elements.iter().any(|b| is_variable(b.as_ref()));
        let mut flags = [
            variable_elements,
            system.elements.iter().any(|b| b.tangent() == Tangent::Unsymmetric),
            // Follower loads are not symmetric and have a matrix of their own.
            variable_elements || system.conditions.iter().any(|b| b.tangent() == Tangent::Symmetric),
        ];
        part.ranks.any_of(&mut flags);
        let [variable_elements, general_elements, variable_bulk] = flags;
        Self { variable_elements, general_elements, variable_bulk }
    }
}

/// Whether the tangent of a block depends on the state.
pub(super) fn is_variable(block: &dyn EntityBlock) -> bool {
    matches!(block.tangent(), Tangent::Symmetric | Tangent::Unsymmetric)
}
