//! Files in which a deck saves a run between stages, and from which it restarts.

use std::path::{Path, PathBuf};

use super::deck::{Folders, StageDeck};
use crate::communication::Ranks;
use crate::diagnostics::{Diagnostic, Place, Result, did_you_mean};
use crate::io::{format_of, replace_file};
use crate::parameters::{Node, Value};

/// Saved runs that a deck names, with Kratos' keys.
#[derive(Default)]
pub(super) struct Checkpoints {
    folder: PathBuf,
    /// Stages after which the run is saved.
    after: Vec<String>,
    /// The saved run to begin with.
    pub from: Option<RestartSource>,
    /// The mesh file of the first stage.
    pub mesh: Option<String>,
}

/// A saved run that the deck begins with.
pub(super) struct RestartSource {
    pub path: PathBuf,
    /// Where the deck names it.
    pub place: Place,
}

const IMPORT: &str = "solver_settings.model_import_settings";

impl Checkpoints {
    /// From the settings of the orchestrator and of the first stage.
    ///
    /// # Errors
    /// Stages that are not there; keys of another type.
    pub(super) fn new(deck: &Node, stages: &[StageDeck], folders: &Folders) -> Result<Self> {
        let setting = |key: &str| deck.get_path(&format!("orchestrator.settings.{key}")).filter(|node| !node.is_null());
        let names: Vec<String> = stages.iter().map(|stage| stage.name.clone()).collect();
        let after = match setting("stage_checkpoints") {
            None => Vec::new(),
            Some(wanted) => match &wanted.value {
                Value::Bool(true) => names.clone(),
                Value::Bool(false) => Vec::new(),
                _ => wanted.array()?.iter().map(|name| Ok(name.str()?.to_owned())).collect::<Result<Vec<String>>>()?,
            },
        };
        if let Some(unknown) = after.iter().find(|name| !names.contains(name)) {
            let place = setting("stage_checkpoints").map(Node::place);
            let hint = did_you_mean(unknown, names.iter().map(String::as_str));
            let problem =
                Diagnostic::error("checkpoint", format!("there is no stage {unknown:?} to save after")).at(place);
            return Err(problem.remedy(hint.unwrap_or_else(|| format!("stages are: {}", names.join(", ")))).into());
        }
        let checkpoints = setting("stage_checkpoints_folder").map(Node::str).transpose()?.unwrap_or("checkpoints");
        let mut from = None;
        if let Some(node) = setting("load_from_checkpoint") {
            from = Some(RestartSource { path: folders.deck.join(node.str()?), place: node.place() });
        }
        let mut mesh = None;
        if let Some(import) = stages.first().and_then(|first| first.settings.get_path(IMPORT)) {
            let name = import.get("input_filename").map(Node::str).transpose()?;
            match import.get("input_type").and_then(Node::as_str) {
                Some("rest") => from = Some(restart(import, &folders.deck)?),
                _ => mesh = name.map(str::to_owned),
            }
        }
        Ok(Self { folder: folders.results.join(checkpoints), after, from, mesh })
    }

    /// The file to save to after a stage, where the deck asks for one.
    pub(super) fn after(&self, stage: &str) -> Option<PathBuf> {
        self.after.iter().any(|name| name == stage).then(|| self.folder.join(stage))
    }

    /// Lets a first stage that names a saved run in place of a mesh read the mesh that it was run on.
    pub(super) fn name_mesh(&mut self, stages: &mut [StageDeck], mesh: Option<String>) {
        let import = stages.first_mut().and_then(|first| first.settings.get_path_mut(IMPORT));
        let (Some(import), Some(mesh)) = (import.filter(|_| self.mesh.is_none()), mesh) else { return };
        if let Value::Object(members) = &mut import.value {
            RESTART_KEYS.iter().for_each(|key| drop(members.remove(key)));
        }
        let format = format_of(Path::new(&mesh)).map_or("mdpa", |format| format.name);
        for (key, text) in [("input_type", format), ("input_filename", mesh.as_str())] {
            if let Some(node) = import.get_path_mut(key) {
                node.value = Value::String(text.to_owned());
            }
        }
        self.mesh = Some(mesh);
    }
}

/// Keys that say where a saved run is, beside `input_filename`.
const RESTART_KEYS: [&str; 4] =
    ["restart_load_file_label", "load_restart_files_from_folder", "input_output_path", "io_foldername"];

/// The saved run that `"input_type": "rest"` names: `PART__restart_files/PART_LABEL.rest`.
///
/// # Errors
/// Keys that are missing or of another type.
fn restart(import: &Node, folder: &Path) -> Result<RestartSource> {
    let text =
        |key: &str| Ok::<_, crate::diagnostics::Error>(import.get(key).map(Node::str).transpose()?.unwrap_or(""));
    let (part, label) = (import.require("input_filename")?.str()?, import.require("restart_load_file_label")?.str()?);
    let (part_folder, name) = part.rsplit_once('/').unwrap_or(("", part));
    let in_folder = import.get("load_restart_files_from_folder").is_none_or(|node| node.as_bool() != Some(false));
    let path = match (text("input_output_path")?, text("io_foldername")?) {
        _ if !in_folder => folder.join(part_folder),
        ("", "") => folder.join(part_folder).join(format!("{name}__restart_files")),
        ("", old) => folder.join(part_folder).join(old),
        (path, _) => folder.join(part_folder).join(path),
    };
    Ok(RestartSource {
        path: path.join(format!("{name}_{label}.rest")),
        place: import.key_place("restart_load_file_label"),
    })
}

/// The file that names the latest saved run of a deck, beside the deck or where its results are.
pub(super) struct LatestRunFile(PathBuf);

impl LatestRunFile {
    /// Pointer file of a deck with results in this folder.
    pub(super) fn of(deck: &Path, results: &Path) -> Self {
        Self(results.join(deck.file_name().unwrap_or_default()).with_extension("resume"))
    }

    /// A saved run beside it.
    pub(super) fn beside(&self) -> PathBuf {
        self.0.with_extension("rest")
    }

    /// Removes the saved run beside it, and itself; what cannot be removed is in nobody's way.
    pub(super) fn remove(&self) {
        for file in [&self.beside(), &self.0] {
            let _ = std::fs::remove_file(file);
        }
    }

    /// The latest saved run; `None` where there is none.
    ///
    /// # Errors
    /// A file that cannot be read, or that names none: to begin anew would cost the results so far.
    pub(super) fn read(&self) -> Result<Option<PathBuf>> {
        let nameless = |fact: String| {
            let remedy = "bring it back, or remove it to run the deck from its start";
            Diagnostic::error("saved-run", fact).at(Place::file(&self.0)).remedy(remedy)
        };
        match std::fs::metadata(&self.0) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Ok(found) if !found.is_file() => return Err(nameless("this is no file".to_owned()).into()),
            _ => {}
        }
        let name = std::fs::read_to_string(&self.0).map_err(|error| nameless(format!("it cannot be read: {error}")))?;
        if name.trim_end().is_empty() {
            return Err(nameless("it names no saved run".to_owned()).into());
        }
        Ok(Some(self.0.parent().unwrap_or(Path::new("")).join(name.trim_end())))
    }

    /// Names the latest.
    ///
    /// # Errors
    /// A disk that refuses.
    pub(super) fn write(&self, ranks: &Ranks, path: &Path) -> Result<()> {
        let folder = self.0.parent().unwrap_or(Path::new(""));
        let name = path.strip_prefix(folder).unwrap_or(path);
        replace_file(ranks, &self.0, |out| std::io::Write::write_all(out, format!("{}\n", name.display()).as_bytes()))
    }
}
