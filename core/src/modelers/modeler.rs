//! The trait of modelers, and the run of a list of them.

use std::path::Path;

use crate::diagnostics::{Diagnostic, Report, Result};
use crate::model::Model;
use crate::parameters::{Defaults, Node, Settings, Value};
use crate::registered_kind;
use crate::registry;

/// Prepares the model before a stage; all of a list take one phase after the other.
pub trait Modeler {
    /// First phase: meshes come into the model.
    ///
    /// # Errors
    /// A file that cannot be read.
    fn setup_geometry_model(&mut self, _model: &mut Model, _report: &mut Report) -> Result<()> {
        Ok(())
    }

    /// Second phase: model parts get their elements and conditions.
    ///
    /// # Errors
    /// Parts and names that do not exist.
    fn setup_model_part(&mut self, _model: &mut Model, _report: &mut Report) -> Result<()> {
        Ok(())
    }
}

/// Makes a modeler from its settings, which are complete; paths are relative to the folder of the deck.
pub type ModelerFactory = fn(&Settings, &Path) -> Result<Box<dyn Modeler>>;

registered_kind! {
    /// A modeler that decks name.
    pub struct ModelerEntry("modeler", "unknown-name") {
        build: ModelerFactory;
    }
}

/// Runs the modelers of a deck.
///
/// # Errors
/// Names that are not registered, unsuitable settings, and faults that the modelers find.
pub fn run_modelers(list: &[Node], folder: &Path, model: &mut Model, report: &mut Report) -> Result<()> {
    let mut all = Vec::new();
    for item in list {
        let made = make(item, folder, report);
        all.extend(report.absorb(made));
    }
    if report.has_errors() {
        return Ok(());
    }
    for modeler in &mut all {
        modeler.setup_geometry_model(model, report)?;
    }
    for modeler in &mut all {
        modeler.setup_model_part(model, report)?;
    }
    Ok(())
}

fn make(item: &Node, folder: &Path, report: &mut Report) -> Result<Box<dyn Modeler>> {
    let named = item.get("name").or_else(|| item.get("modeler_name")).ok_or_else(|| {
        let remedy = "`zelus list modeler` shows the names";
        Diagnostic::error("missing-key", "a modeler without \"name\"").at(item.place()).remedy(remedy)
    })?;
    let name = named.str()?.rsplit('.').next().unwrap_or_default();
    let entry = registry::require::<ModelerEntry>(name).map_err(|problem| problem.at(named.place()))?;
    let empty = Node::new(Value::Object(Default::default()), &item.place());
    let parameters = item.get("parameters").or_else(|| item.get("Parameters")).unwrap_or(&empty);
    let (settings, warnings) = Settings::check(parameters, &Defaults::parse(entry.name, entry.defaults)?)?;
    warnings.into_iter().for_each(|warning| report.push(warning));
    (entry.build)(&settings, folder)
}
