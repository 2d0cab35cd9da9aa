//! What the processes of contact and ties end in: at the start of the stage the interaction joins its model part.

use zelus_core::Result;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::entities::Interaction;
use zelus_core::model::Model;
use zelus_core::processes::Process;

/// Puts an interaction into a root model part, and does nothing else.
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
    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        let interaction = self.interaction.take().ok_or_else(|| Diagnostic::error("contact", "initialised twice"))?;
        model.root_mut(&self.root)?.interactions.push(interaction);
        Ok(())
    }
}
