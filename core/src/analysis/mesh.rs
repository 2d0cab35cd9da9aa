//! The mesh of a deck alone, for callers that need nothing else.

use std::path::Path;

use super::deck::{import, import_materials, open, root_name, stages};
use super::older_decks::{complete_part_names, modernise};
use super::report::RunReport;
use super::sharing::common_of_stage;
use super::solver::SolverSettings;
use crate::diagnostics::{Diagnostic, Error, Report, Result};
use crate::model::{Model, ModelPart};
use crate::modelers::run_modelers;
use crate::partition::{Surface, surfaces};

/// A mesh, and its entities that all ranks have.
pub struct DeckMesh {
    /// The model part that the first stage reads.
    pub part: ModelPart,
    /// Its surfaces that may touch.
    pub surfaces: Vec<Surface>,
    /// Marks of the nodes that every rank keeps.
    pub common: Vec<bool>,
}

/// The mesh of the first stage of a deck.
///
/// # Errors
/// A deck or mesh that cannot be read.
pub fn read_deck_mesh(path: &Path) -> Result<DeckMesh> {
    let (deck, folder) = open(path)?;
    let all = stages(&deck.root, &mut RunReport::default())?;
    let stage = all.first().ok_or_else(|| {
        Error::from(
            Diagnostic::error("no-stage", "the deck has no stage").at(deck.root.place()).remedy("list one to run"),
        )
    })?;
    let mut problems = Report::new();
    let mut settings = modernise(&stage.settings, &mut problems);
    let solver = SolverSettings::new(settings.require("solver_settings")?, &mut problems)?;
    let root = root_name(&solver.settings)?;
    let mut model = Model::default();
    run_modelers(&stage.modelers, &folder, &mut model, &mut problems)?;
    import(&solver, &root, &folder, &mut model, &mut problems)?;
    import_materials(&solver, &root, &folder, &mut model, &mut problems)?;
    complete_part_names(&mut settings, &root, &model, &mut problems);
    problems.finish()?;
    let part = model.parts.remove(&root).ok_or_else(|| Error::System(format!("the stage has no model part {root}")))?;
    let surfaces = surfaces(&settings, &part);
    let common = common_of_stage(&part, &surfaces, &settings);
    Ok(DeckMesh { part, surfaces, common })
}
