//! Removes model parts with everything in them.

use std::path::Path;

use super::modeler::{Modeler, ModelerEntry};
use crate::diagnostics::{Diagnostic, Place, Report, Result};
use crate::model::Model;
use crate::parameters::Settings;
use crate::register;

struct DeleteModelParts {
    names: Vec<String>,
    place: Place,
}

fn build(settings: &Settings, _folder: &Path) -> Result<Box<dyn Modeler>> {
    let names = settings.get_strings("model_part_names")?;
    Ok(Box::new(DeleteModelParts { names, place: settings.key_place("model_part_names") }))
}

impl Modeler for DeleteModelParts {
    /// A sub part is only a name for its members: they stay with the parts above it.
    fn setup_model_part(&mut self, model: &mut Model, report: &mut Report) -> Result<()> {
        for name in &self.names {
            let removed = match name.rsplit_once('.') {
                None => model.parts.remove(name).is_some(),
                Some((above, last)) => {
                    let above = model.root_mut(name).ok().and_then(|root| root.part_mut(above).ok());
                    above.is_some_and(|above| above.children.remove(last).is_some())
                }
            };
            if !removed {
                let fact = format!("there is no model part {name:?} that could be deleted");
                report.push(Diagnostic::warning("unknown-model-part", fact).at(self.place.clone()));
            }
        }
        Ok(())
    }
}

register! { ModelerEntry "DeleteModelPartsModeler",
    aliases: &["delete_model_parts_modeler"],
    about: "removes model parts with everything in them",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/modelers/DeleteModelPartsModeler.json")),
    build: build,
}
