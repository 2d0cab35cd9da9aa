//! Reads an mdpa file into a new model part.

use std::path::{Path, PathBuf};

use super::modeler::{Modeler, ModelerEntry};
use crate::diagnostics::{Diagnostic, Place, Report, Result};
use crate::io::{MeshFormatEntry, read_mesh_as};
use crate::model::{Model, ModelPart};
use crate::parameters::{Node, Object, Settings, Value};
use crate::{register, registry};

struct ImportMdpa {
    part: String,
    path: PathBuf,
    place: Place,
}

fn build(settings: &Settings, folder: &Path) -> Result<Box<dyn Modeler>> {
    let part = settings.get_str("model_part_name")?;
    if part.is_empty() || part.contains('.') {
        let fact = format!("\"model_part_name\" is {part:?}");
        let remedy = "name the root part that is to hold the mesh, e.g. \"Structure\"";
        return Err(settings.error("model_part_name", "model-part-name", fact).remedy(remedy).into());
    }
    let path = folder.join(settings.get_str("input_filename")?);
    Ok(Box::new(ImportMdpa { part: part.to_owned(), path, place: settings.key_place("input_filename") }))
}

impl Modeler for ImportMdpa {
    fn setup_geometry_model(&mut self, model: &mut Model, report: &mut Report) -> Result<()> {
        if model.parts.contains_key(&self.part) {
            let fact = format!("there is a model part {:?} already", self.part);
            return Err(Diagnostic::error("repeated-part", fact).at(self.place.clone()).into());
        }
        let mut part = ModelPart::new(self.part.clone());
        let mdpa = registry::require::<MeshFormatEntry>("mdpa")?;
        let no_settings = Node::new(Value::Object(Object::default()), &self.place);
        let warnings = read_mesh_as(mdpa, &no_settings, &self.path, &self.place, &mut part)?;
        warnings.into_iter().for_each(|warning| report.push(warning));
        model.add(part);
        Ok(())
    }
}

register! { ModelerEntry "ImportMDPAModeler",
    aliases: &["import_mdpa_modeler"],
    about: "reads an mdpa file into a new model part",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/modelers/ImportMDPAModeler.json")),
    build: build,
}
