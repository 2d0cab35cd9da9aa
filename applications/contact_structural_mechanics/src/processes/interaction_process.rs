//! A process that gives the system of its stage an interaction: the end of all processes of contact and ties.

use zelus_core::Result;
use zelus_core::assembly::System;
use zelus_core::entities::Interaction;
use zelus_core::model::{Model, ModelPart};
use zelus_core::processes::Process;

/// Gives an interaction to the stage, and does nothing else.
pub(super) struct InteractionProcess {
    root: String,
    interaction: Option<Box<dyn Interaction>>,
}

impl InteractionProcess {
    /// The process that adds `interaction` to the root part of this name.
    pub(super) fn boxed(root: String, interaction: impl Interaction + 'static) -> Box<dyn Process> {
        Box::new(Self { root, interaction: Some(Box::new(interaction)) })
    }
}

impl Process for InteractionProcess {
    fn drives(&self, _part: &ModelPart, _system: &System) -> bool {
        false
    }

    fn interaction(&mut self, _model: &mut Model) -> Result<Option<(String, Box<dyn Interaction>)>> {
        Ok(self.interaction.take().map(|interaction| (self.root.clone(), interaction)))
    }
}
