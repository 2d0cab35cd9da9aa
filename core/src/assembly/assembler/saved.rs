//! What the assembler remembers between steps: what tells whether the next system is the last one.

use serde::{Deserialize, Serialize};

use super::{Assembler, Stamps, bulk_pattern};
use crate::Carrier;
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
    /// See [`State::carry`](crate::State::carry): equations are found anew.
    pub fn carry(&mut self, carrier: &mut dyn Carrier) {
        self.equations = Equations::default();
        self.redistribution.carry(carrier);
    }
}

impl Assembler {
    /// What it remembers between steps.
    pub fn state(&self) -> AssemblerState {
        AssemblerState {
            equations: self.equations.roles_only(),
            stamps: self.stamps,
            reduced_graph: self.reduced_graph,
            tangent_key: self.tangent_key,
            redistribution: self.redistribution.clone(),
        }
    }

    /// Takes up what it remembered of the same part and system.
    ///
    /// # Errors
    /// What is of another part or system.
    pub fn resume(&mut self, part: &ModelPart, system: &System, state: AssemblerState) -> Result<()> {
        let AssemblerState { equations, stamps, reduced_graph, tangent_key, redistribution } = state;
        if !redistribution.is_of(part.nodes.len(), system.dofs.len()) {
            return Err(unfit("the nodes without mass that it remembers are not there"));
        }
        let groups = redistribution.groups(part);
        if !groups.is_empty() {
            self.pattern = bulk_pattern(part, system, &groups);
        }
        self.incomplete = true;
        (self.equations, self.stamps, self.redistribution) = (equations, stamps, redistribution);
        (self.reduced_graph, self.tangent_key) = (reduced_graph, tangent_key);
        Ok(())
    }
}
