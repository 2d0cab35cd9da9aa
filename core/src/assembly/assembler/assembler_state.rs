//! State of the assembler between steps: it tells whether the next system equals the last one.

use serde::{Deserialize, Serialize};

use super::Assembler;
use super::stamps::Stamps;
use crate::StateMapper;
use crate::assembly::System;
use crate::assembly::equations::Equations;
use crate::assembly::redistribution::Redistribution;
use crate::diagnostics::{Result, unfit};
use crate::model::ModelPart;

/// Equations, stamps and massless nodes of the last step; matrices are made anew of them.
#[derive(Serialize, Deserialize)]
pub struct AssemblerState {
    equations: Equations,
    stamps: Stamps,
    reduced_graph: u64,
    tangent_key: Option<[f64; 4]>,
    redistribution: Redistribution,
}

impl AssemblerState {
    /// See [`State::remap`](crate::State::remap): equations are found anew.
    pub fn remap(&mut self, mapper: &mut dyn StateMapper) {
        self.equations = Equations::default();
        self.redistribution.remap(mapper);
    }
}

impl Assembler {
    /// State between steps.
    pub fn state(&self) -> AssemblerState {
        let (reduced_graph, tangent_key) = self.bulk.origin();
        AssemblerState {
            equations: self.equations.map().roles_only(),
            stamps: self.stamps,
            reduced_graph,
            tangent_key,
            redistribution: self.inertia.redistribution.clone(),
        }
    }

    /// Restores the state of the same part and system.
    ///
    /// # Errors
    /// A state of another part or system.
    pub fn resume(&mut self, part: &ModelPart, system: &System, state: AssemblerState) -> Result<()> {
        let AssemblerState { equations, stamps, reduced_graph, tangent_key, redistribution } = state;
        if !redistribution.is_of(part.nodes.len(), system.dofs.len()) {
            return Err(unfit("the nodes without mass that it remembers are not there"));
        }
        let groups = redistribution.groups(part);
        if !groups.is_empty() {
            self.bulk.lay_out(part, system, &groups);
        }
        self.equations.resume(equations);
        (self.stamps, self.inertia.redistribution) = (stamps, redistribution);
        self.bulk.resume(reduced_graph, tangent_key);
        Ok(())
    }
}
