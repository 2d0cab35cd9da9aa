//! The mesh of a deck alone, for what needs nothing else.

use std::path::Path;

use super::older_decks::{complete_part_names, modernise};
use super::orchestrator::{open, stages};
use super::report::RunReport;
use super::solver::SolverSettings;
use super::deck::{import, root_name};
use crate::diagnostics::{Diagnostic, Error, Report, Result};
use crate::model::{Model, ModelPart};
use crate::partition::{Surface, surfaces};

/// The model part that the first stage of a deck reads, and its surfaces that may touch.
///
/// # Errors
/// A deck or mesh that cannot be read.
pub fn read_deck_mesh(path: &Path) -> Result<(ModelPart, Vec<Surface>)> {
    let (deck, folder) = open(path)?;
    let all = stages(&deck, &mut RunReport::default())?;
    let (_, stage) = all.first().ok_or_else(|| {
        Error::from(Diagnostic::error("no-stage", "the deck has no stage").at(deck.place()).remedy("list one to run"))
    })?;
    let mut problems = Report::new();
    let mut stage = modernise(stage, &mut problems);
    let solver = SolverSettings::new(stage.require("solver_settings")?, &mut problems)?;
    let root = root_name(&solver.settings)?;
    let mut model = Model::default();
    import(&solver, &root, &folder, &mut model, &mut problems)?;
    complete_part_names(&mut stage, &root, &model, &mut problems);
    problems.finish()?;
    let part = model.parts.remove(&root).ok_or_else(|| Error::System(format!("the stage has no model part {root}")))?;
    let surfaces = surfaces(&stage, &part);
    Ok((part, surfaces))
}
