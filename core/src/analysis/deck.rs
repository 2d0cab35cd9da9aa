//! A deck as stages; each with the keys at its top level, mesh, materials and processes.

use std::path::{Path, PathBuf};

use super::driver::Driver;
use super::report::RunReport;
use super::solver::{SolverSettings, flatten_bars};
use crate::diagnostics::{Diagnostic, Error, Report, Result, did_you_mean};
use crate::io::{self, MeshFormatEntry};
use crate::model::{Model, ModelPart};
use crate::parameters::{Document, Node, Settings, Value};
use crate::processes::{Process, ProcessEntry, ProcessRequest, other_problems};
use crate::registry;

/// The parsed deck, and its folder.
pub(super) fn open(path: &Path) -> Result<(Document, PathBuf)> {
    let folder = path.parent().map(Path::to_owned).unwrap_or_default();
    Ok((Document::read(path)?, folder))
}

/// One stage of a deck.
pub(super) struct StageDeck {
    /// Its name among the stages, or that of the problem where there is only one.
    pub name: String,
    /// Solver, processes and times.
    pub settings: Node,
    /// Modelers to run before it, in order.
    pub modelers: Vec<Node>,
}

impl StageDeck {
    /// # Errors
    /// Lists of modelers that are no lists.
    fn new(name: String, settings: &Node, before: Option<&Node>) -> Result<Self> {
        let mut modelers = Vec::new();
        for list in before.into_iter().chain(settings.get("modelers")) {
            modelers.extend(list.array()?.iter().cloned());
        }
        Ok(Self { name, settings: settings.clone(), modelers })
    }
}

/// The stages of a deck in order.
///
/// # Errors
/// An orchestrator, stages or work between them that is not run.
pub(super) fn stages(deck: &Node, report: &mut RunReport) -> Result<Vec<StageDeck>> {
    let name_of = |deck: &Node| deck.get_path("problem_data.problem_name").and_then(|n| n.as_str().map(str::to_owned));
    if deck.get("orchestrator").is_none() {
        let name = name_of(deck).unwrap_or_default();
        report.problem.clone_from(&name);
        return Ok(vec![StageDeck::new(name, deck, None)?]);
    }
    refuse_other_orchestrators(deck)?;
    let all = deck.require("stages")?.object()?;
    let order: Vec<String> = match deck.get_path("orchestrator.settings.execution_list") {
        Some(list) => list.array()?.iter().map(|n| n.str().map(str::to_owned)).collect::<Result<_>>()?,
        None => all.keys().map(str::to_owned).collect(),
    };
    let mut out = Vec::new();
    for name in order {
        let stage = all.get(&name).ok_or_else(|| {
            let hint = did_you_mean(&name, all.keys()).unwrap_or_else(|| "stages are the members of \"stages\"".into());
            Error::from(
                Diagnostic::error("unknown-stage", format!("there is no stage {name:?}")).at(deck.place()).remedy(hint),
            )
        })?;
        for key in ["stage_preprocess", "stage_postprocess"] {
            refuse_work_between_stages(stage, key)?;
        }
        let settings = stage.require("stage_settings")?;
        report.problem = name_of(settings).unwrap_or_default();
        out.push(StageDeck::new(name, settings, stage.get_path("stage_preprocess.modelers"))?);
    }
    Ok(out)
}

/// Stages run one after another, from the first.
fn refuse_other_orchestrators(deck: &Node) -> Result<()> {
    if let Some(name) = deck.get_path("orchestrator.name")
        && !name.str()?.ends_with("SequentialOrchestrator")
    {
        let fact = format!("there is no orchestrator {:?}", name.str()?);
        let remedy = "use \"Orchestrators.KratosMultiphysics.SequentialOrchestrator\"";
        return Err(Diagnostic::error("orchestrator", fact).at(name.place()).remedy(remedy).into());
    }
    Ok(())
}

fn refuse_work_between_stages(stage: &Node, key: &str) -> Result<()> {
    let Some(work) = stage.get(key).and_then(Node::as_object) else { return Ok(()) };
    let is_empty = |node: &Node| match &node.value {
        Value::Array(items) => items.is_empty(),
        Value::Object(members) => members.iter().next().is_none(),
        _ => false,
    };
    let runs = |name: &str| key == "stage_preprocess" && name == "modelers";
    match work.in_source_order().iter().find(|member| !runs(&member.key) && !is_empty(&member.node)) {
        None => Ok(()),
        Some(member) => Err(Diagnostic::error("stage-work", format!("\"{}\" of \"{key}\" is not run", member.key))
            .at(member.node.place())
            .remedy("put processes into the \"processes\" of a stage's settings, and take this out")
            .into()),
    }
}

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

/// The key by which a deck names its JSON Schema to editors.
const SCHEMA: &str = "$schema";

/// Warns of keys beside the sections of a deck.
pub(super) fn check_top_level(deck: &Node, known: &[&str], problems: &mut Report) -> Result<()> {
    for key in deck.object()?.keys().filter(|key| !known.contains(key) && *key != SCHEMA) {
        problems.push(if key.starts_with('_') {
            let fact = format!("\"{key}\" starts with an underscore and is not read");
            Diagnostic::warning("disabled-key", fact).at(deck.key_place(key))
        } else {
            unread_key(deck, key, format!("\"{key}\" at the top level is not read"), known)
        });
    }
    Ok(())
}

/// The warning that nothing reads a key of `object`, whose `known` keys are read.
pub(super) fn unread_key(object: &Node, key: &str, fact: String, known: &[&str]) -> Diagnostic {
    let near = did_you_mean(key, known.iter().copied());
    let remedy = near.unwrap_or_else(|| match known {
        [] => "remove it: the object has no keys".to_owned(),
        _ => format!("read are: {}", known.join(", ")),
    });
    Diagnostic::warning("unknown-key-ignored", fact).at(object.key_place(key)).remedy(remedy)
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
                format!("no earlier stage and no modeler has made a model part {root:?}"),
            )
            .at(import.key_place("input_type"))
            .remedy("read it from a file with \"input_type\": \"mdpa\", or by an ImportMDPAModeler in \"modelers\"")
            .into());
        }
        name => {
            let format = registry::find::<MeshFormatEntry>(name).ok_or_else(|| {
                let formats: Vec<&str> = registry::all::<MeshFormatEntry>().iter().map(|format| format.name).collect();
                let formats = formats.join(", ");
                Diagnostic::error("input-type", format!("\"input_type\" is {name:?}"))
                    .at(import.key_place("input_type"))
                    .remedy(format!("use {formats}, \"use_input_model_part\" or, in the first stage, \"rest\""))
            })?;
            if existing {
                model.parts.remove(root);
            }
            let mut part = ModelPart::new(root);
            let name = import.node().require("input_filename")?;
            solver.prepare(&mut part)?;
            let path = folder.join(name.str()?);
            io::read_mesh_as(format, import.node(), &path, &name.place(), &mut part)?
                .into_iter()
                .for_each(|w| warnings.push(w));
            model.add(part);
        }
    }
    let part = model.root_mut(root)?;
    flatten_bars(part, solver.domain_size()?, warnings);
    solver.prepare(part)?;
    if !part.geometries.is_empty() && !part.geometries.used {
        let fact = "geometries without elements or conditions on them are not used";
        let remedy = "CreateEntitiesFromGeometriesModeler in \"modelers\" makes elements and conditions on them";
        warnings.push(Diagnostic::warning("unused-block", fact).at(part.geometries.place.clone()).remedy(remedy));
    }
    for kind in part.elements.kinds.iter().chain(&part.conditions.kinds).filter(|kind| !kind.nodal.is_empty()) {
        kind.nodal.iter().for_each(|&(name, components)| part.nodes.history.add_named(name, components));
    }
    Ok(())
}

/// Gives the part the materials that the settings name, and lets the solver adapt it.
///
/// # Errors
/// A file that cannot be read, materials that do not fit.
pub(super) fn import_materials(
    solver: &SolverSettings,
    root: &str,
    folder: &Path,
    model: &mut Model,
    warnings: &mut Report,
) -> Result<()> {
    let part = model.root_mut(root)?;
    let materials = solver.settings.get("material_import_settings.materials_filename")?;
    let name = materials.str()?;
    if !name.is_empty() {
        io::read_materials_of(&folder.join(name), &materials.place(), part)?.into_iter().for_each(|w| warnings.push(w));
    }
    solver.adopt(folder, part, warnings)
}

/// The mesh that settings of a solver name, with its format.
pub(super) fn mesh_file(solver: &Node, folder: &Path) -> Option<(&'static MeshFormatEntry, PathBuf)> {
    let named = |key: &str| solver.get_path(key).and_then(Node::as_str).filter(|name| !name.is_empty());
    let format = registry::find::<MeshFormatEntry>(named("model_import_settings.input_type").unwrap_or("mdpa"))?;
    Some((format, format.file(&folder.join(named("model_import_settings.input_filename")?))))
}

/// Replacement for a mesh that could not be read: a part with the names of its parts alone, so that other problems of the deck are
/// found, too; `None` where there are no names.
pub(super) fn add_names_only(solver: &SolverSettings, root: &str, folder: &Path, model: &mut Model) -> Option<()> {
    let (format, file) = mesh_file(solver.settings.node(), folder)?;
    if format.name != "mdpa" {
        return None;
    }
    model.parts.remove(root);
    let mut part = ModelPart::new(root);
    part.tree.children = io::names_of_parts(&file)?;
    // Faults of the settings were reported when the mesh was read.
    let _ = solver.prepare(&mut part);
    part.info.solver.incomplete = true;
    model.add(part);
    Some(())
}

/// The entries of `processes`, list by list in the order of their names, then those of `output_processes`.
pub(super) fn listed<'a>(deck: &'a Node, problems: &mut Report) -> Vec<&'a Node> {
    let mut out = Vec::new();
    for section in ["processes", "output_processes"].iter().filter_map(|section| deck.get(section)) {
        for list in problems.absorb(section.object()).into_iter().flat_map(|lists| lists.iter()) {
            out.extend(problems.absorb(list.node.array()).into_iter().flatten());
        }
    }
    out
}

/// Where names of files begin.
#[derive(Debug, Clone)]
pub(super) struct Folders {
    /// Folder of input files: that of the deck.
    pub deck: PathBuf,
    /// Folder of output files.
    pub results: PathBuf,
}

/// Lets the processes of a deck change the mesh as read. The warnings on their settings come when they are made.
pub(super) fn prepare_mesh(deck: &Node, folders: &Folders, model: &mut Model, problems: &mut Report) {
    for item in listed(deck, &mut Report::new()) {
        let name = item.get("python_module").or(item.get("name")).and_then(Node::as_str).unwrap_or_default();
        let Some(entry) = registry::find::<ProcessEntry>(name.rsplit('.').next().unwrap_or_default()) else { continue };
        let Some(parameters) = item.get("Parameters") else { continue };
        let (folder, results, report) = (&*folders.deck, &*folders.results, &mut Report::new());
        let mut request = ProcessRequest { entry, parameters, model: &mut *model, folder, results, report };
        problems.absorb((entry.prepares)(&mut request).map_err(|error| error.at(&parameters.place())));
    }
}

/// The processes of a deck.
pub(super) fn make_processes(
    deck: &Node,
    folders: &Folders,
    model: &mut Model,
    driver: &mut dyn Driver,
    problems: &mut Report,
) -> Vec<Box<dyn Process>> {
    let mut out = Vec::new();
    for item in listed(deck, problems) {
        let made = match driver.process(item, model).map_err(|error| error.at(&item.place())) {
            Ok(Some(process)) => Ok(process),
            Ok(None) => make_process(item, folders, model, problems),
            Err(error) => Err(error),
        };
        out.extend(problems.absorb(made));
    }
    out
}

fn make_process(item: &Node, folders: &Folders, model: &mut Model, problems: &mut Report) -> Result<Box<dyn Process>> {
    let module = match item.get("python_module") {
        Some(module) => module,
        None => item.get("name").ok_or_else(|| {
            let fact = "a process without \"python_module\" or \"name\"";
            Diagnostic::error("missing-key", fact).at(item.place()).remedy("`zelus list process` shows the names")
        })?,
    };
    let name = module.str()?.rsplit('.').next().unwrap_or_default();
    let entry = registry::require::<ProcessEntry>(name).map_err(|d| d.at(module.place()))?;
    let empty = Node::new(Value::Object(Default::default()), &item.place());
    let parameters = item.get("Parameters").unwrap_or(&empty);
    let place = parameters.place();
    let Folders { deck: folder, results } = folders;
    let made = (entry.build)(&mut ProcessRequest { entry, parameters, model, folder, results, report: problems });
    made.map_err(|error| match error.at(&place) {
        Error::Input(mut list) => {
            let mut more = other_problems(entry, parameters, model);
            more.retain(|problem| list.iter().all(|known| known.place != problem.place));
            list.extend(more);
            Error::Input(list)
        }
        other => other,
    })
}
