//! Heat beside a structure: its strategy, and the system that this solves.

use zelus_core::assembly::System;
use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::ModelPart;
use zelus_core::strategies::{Monitor, SolutionStrategy, StepRecord};
use zelus_linear_algebra::State;

use crate::columns::Columns;
use crate::plastic_heat::PlasticHeat;

/// Heat beside a structure.
pub(crate) struct Heat {
    pub(crate) strategy: Box<dyn SolutionStrategy>,
    /// Unknowns and blocks of heat.
    pub(crate) system: System,
    /// The part of it that plastic flow makes.
    pub(crate) plastic: PlasticHeat,
    /// The last solve of the step, where it was solved again.
    pub(crate) last: Option<StepRecord>,
    /// How often it was, in this step.
    pub(crate) sweeps: usize,
}

impl Heat {
    pub(crate) fn solve_step(&mut self, part: &mut ModelPart, monitor: &mut dyn Monitor) -> Result<StepRecord> {
        check_rigid_shapes(part)?;
        self.strategy.solve_step(part, &mut self.system, monitor)
    }

    pub(crate) fn finalize_step(&mut self, part: &mut ModelPart) -> Result<()> {
        self.strategy.finalize_step(part, &mut self.system)
    }

    pub(crate) fn resume(&mut self, part: &ModelPart, state: Box<dyn State>) -> Result<()> {
        self.strategy.resume(part, &self.system, state)
    }

    pub(crate) fn messages(&mut self) -> Vec<Diagnostic> {
        let mut all = self.strategy.messages();
        all.extend(self.system.interactions.iter_mut().flat_map(|interaction| interaction.messages()));
        all
    }

    pub(crate) fn last_messages(&self, part: &ModelPart) -> Vec<Diagnostic> {
        self.system.interactions.iter().flat_map(|interaction| interaction.last_messages(part)).collect()
    }
}

/// Rigid shapes conduct no heat: their temperatures are prescribed.
///
/// # Errors
/// A node of a rigid shape whose temperature is free.
fn check_rigid_shapes(part: &ModelPart) -> Result<()> {
    let unknown = Columns::of(part).unknown;
    let mut nodes = part.rigid_facets.keys().flat_map(|&at| part.conditions.nodes(at));
    let Some(&node) = nodes.find(|&&node| !part.nodes.is_fixed(unknown, node)) else { return Ok(()) };
    let fact = format!(
        "{} of node {} of a rigid shape is not prescribed, and rigid shapes conduct no heat",
        unknown.column, part.nodes.ids[node as usize]
    );
    let remedy = format!(
        "prescribe {} on the part of the shape, e.g. by assign_scalar_variable_process; mesh a tool that warms up",
        unknown.column
    );
    Err(Diagnostic::error("rigid-shape-temperature", fact).remedy(remedy).into())
}
