//! What a stage reads of its deck: the keys at its top level, mesh and materials, processes.

use std::path::{Path, PathBuf};

use super::solver::{SolverSettings, flatten_points};
use crate::diagnostics::{Diagnostic, Error, Report, Result};
use crate::io;
use crate::model::{Model, ModelPart};
use crate::parameters::{Node, Settings};
use crate::processes::{Process, ProcessRequest};
use crate::registry::{self, Build, Kind};

/// Name of the root part that the settings name.
///
/// # Errors
/// None, or one without letters.
pub(super) fn root_name(settings: &Settings) -> Result<String> {
    let name = settings.get_str("model_part_name")?;
    if name.is_empty() {
        return Err(settings
            .error("model_part_name", "model-part-name", "\"model_part_name\" is empty")
            .remedy("name the root part, e.g. \"Structure\"")
            .into());
    }
    Ok(name.to_owned())
}

pub(super) fn check_top_level(key: &str, known: &[&str], deck: &Node, problems: &mut Report) {
    if known.contains(&key) {
        return;
    }
    if key.starts_with('_') {
        problems.push(
            Diagnostic::warning("disabled-key", format!("\"{key}\" starts with an underscore and is not read"))
                .at(deck.key_place(key)),
        );
    } else {
        let hint = crate::diagnostics::did_you_mean(key, known.iter().copied());
        problems.push(
            Diagnostic::warning("unknown-key-ignored", format!("\"{key}\" at the top level is not read"))
                .at(deck.key_place(key))
                .remedy(hint.unwrap_or_else(|| format!("read are: {}", known.join(", ")))),
        );
    }
}

/// Reads the mesh that the settings name into the model, unless an earlier stage has.
///
/// # Errors
/// Settings that do not fit, a file that cannot be read.
pub(super) fn import(
    solver: &SolverSettings,
    root: &str,
    folder: &Path,
    model: &mut Model,
    warnings: &mut Report,
) -> Result<()> {
    let settings = &solver.settings;
    let import = settings.sub("model_import_settings")?;
    let input_type = import.node().get("input_type").map(Node::str).transpose()?.unwrap_or("mdpa");
    let existing = model.parts.contains_key(root);
    match input_type {
        "use_input_model_part" if existing => {}
        "use_input_model_part" => {
            return Err(Diagnostic::error(
                "no-model-part",
                format!("there is no model part {root:?} from an earlier stage"),
            )
            .at(import.key_place("input_type"))
            .remedy("read it from a file with \"input_type\": \"mdpa\"")
            .into());
        }
        "mdpa" => {
            if existing {
                model.parts.remove(root);
            }
            let mut part = ModelPart::new(root);
            let name = import.node().require("input_filename")?;
            let path = with_extension(folder.join(name.str()?), "mdpa");
            if !path.is_file() {
                return Err(Diagnostic::error("missing-file", format!("there is no mesh file {}", path.display()))
                    .at(name.place())
                    .remedy("\"input_filename\" is relative to the deck and has no extension")
                    .into());
            }
            solver.prepare(&mut part)?;
            io::read_mesh(&path, &mut part)?.into_iter().for_each(|w| warnings.push(w));
            model.parts.insert(root.to_owned(), part);
        }
        other => {
            return Err(Diagnostic::error("input-type", format!("\"input_type\" is {other:?}"))
                .at(import.key_place("input_type"))
                .remedy("use \"mdpa\" or \"use_input_model_part\"")
                .into());
        }
    }
    let part = model.root_mut(root)?;
    flatten_points(part, solver.domain_size()?, warnings);
    solver.prepare(part)?;
    for kind in part.elements.kinds.iter().chain(&part.conditions.kinds).filter(|kind| !kind.nodal.is_empty()) {
        kind.nodal.iter().for_each(|&(name, components)| part.nodes.history.add_named(name, components));
    }
    let materials = settings.get("material_import_settings.materials_filename")?;
    let name = materials.str()?;
    if !name.is_empty() {
        let path = folder.join(name);
        if !path.is_file() {
            return Err(Diagnostic::error("missing-file", format!("there is no materials file {}", path.display()))
                .at(materials.place())
                .remedy("\"materials_filename\" is relative to the deck")
                .into());
        }
        io::read_materials(&path, part)?.into_iter().for_each(|w| warnings.push(w));
    }
    Ok(())
}

fn with_extension(path: PathBuf, extension: &str) -> PathBuf {
    let mut name = path.into_os_string();
    if !PathBuf::from(&name).extension().is_some_and(|e| e == extension) {
        name.push(".");
        name.push(extension);
    }
    PathBuf::from(name)
}

/// The processes of `processes`, list by list in the order of their names, then those of `output_processes`.
pub(super) fn make_processes(deck: &Node, folder: &Path, model: &mut Model, problems: &mut Report) -> Vec<Box<dyn Process>> {
    let mut out = Vec::new();
    for section in ["processes", "output_processes"] {
        let Some(lists) = deck.get(section) else { continue };
        let Some(lists) = problems.absorb(lists.object()) else { continue };
        for list in lists.iter() {
            let Some(items) = problems.absorb(list.node.array()) else { continue };
            for item in items {
                let made = make_process(item, folder, model, problems);
                if let Some(process) = problems.absorb(made) {
                    out.push(process);
                }
            }
        }
    }
    out
}

fn make_process(item: &Node, folder: &Path, model: &mut Model, problems: &mut Report) -> Result<Box<dyn Process>> {
    let module = match item.get("python_module") {
        Some(module) => module,
        None => item.get("name").ok_or_else(|| {
            let fact = "a process without \"python_module\" or \"name\"";
            Diagnostic::error("missing-key", fact).at(item.place()).remedy("`zelus list process` shows the names")
        })?,
    };
    let name = module.str()?.rsplit('.').next().unwrap_or_default();
    let entry = registry::require(Kind::Process, name).map_err(|d| d.at(module.place()))?;
    let Build::Process(factory) = entry.build else { unreachable!("processes register a factory") };
    let empty = Node::new(crate::parameters::Value::Object(Default::default()), &item.place());
    let parameters = item.get("Parameters").unwrap_or(&empty);
    let place = parameters.place();
    factory(&mut ProcessRequest { entry, parameters, model, folder, report: problems }).map_err(|error| match error {
        Error::Input(list) => {
            Error::Input(list.into_iter().map(|d| if d.place.is_none() { d.at(place.clone()) } else { d }).collect())
        }
        other => other,
    })
}
