//! The model part an output process works on, and the place in the deck to blame.

use std::path::{Path, PathBuf};

use crate::diagnostics::{Diagnostic, Place, Result};
use crate::model::{Model, ModelPart, SubPart};
use crate::parameters::Settings;

/// A model part by its path.
#[derive(Debug, Clone)]
pub(super) struct PartPath {
    /// Full dotted path.
    pub(super) path: String,
    pub(super) place: Place,
}

impl PartPath {
    /// Reads `"model_part_name"` and, where the settings have it, `"sub_model_part_name"`.
    pub(super) fn new(settings: &Settings) -> Result<Self> {
        let mut path = settings.get_str("model_part_name")?.to_owned();
        let place = settings.key_place("model_part_name");
        if path.is_empty() {
            let problem = settings.error("model_part_name", "missing-key", "\"model_part_name\" must name a part");
            return Err(problem.remedy("write the full path, e.g. \"Structure.Parts\"").into());
        }
        if let Some(sub) = settings.node().get("sub_model_part_name").and_then(|n| n.as_str()).filter(|s| !s.is_empty())
        {
            path = format!("{path}.{sub}");
        }
        Ok(Self { path, place })
    }

    /// The root part and the selection in it.
    ///
    /// # Errors
    /// `unknown-model-part`, at the key of the deck.
    pub(super) fn find<'m>(&self, model: &'m Model) -> Result<(&'m ModelPart, &'m SubPart)> {
        let found = model.root(&self.path).and_then(|root| Ok((root, root.part(&self.path)?)));
        found.map_err(|error| error.at(&self.place))
    }
}

/// The warning that an output holds no values, by the process `by`, since `why`.
pub(super) fn no_output(by: &str, why: &str, place: &Place) -> Diagnostic {
    let fact = format!("{by} writes no values of any step: {why}");
    let remedy = "correct part, variables, flag or interval of the output, or remove the process";
    Diagnostic::warning("no-output", fact).at(place.clone()).remedy(remedy)
}

/// Reason why an output has no values, where its steps lie beyond the run.
pub(super) const NO_STEP: &str = "no step of the run is one of its interval of output";

/// Reason why an output has no values, where its lists are empty.
pub(super) const NO_VARIABLE: &str = "it names no variable";

/// One of the words a setting may be.
///
/// # Errors
/// `invalid-value` naming the words.
pub(super) fn one_of(settings: &Settings, key: &str, words: &[&str]) -> Result<usize> {
    let given = settings.get_str(key)?;
    words.iter().position(|word| *word == given).ok_or_else(|| {
        let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
        let last = key.rsplit('.').next().unwrap_or(key);
        settings
            .error(key, "invalid-value", format!("\"{last}\" is \"{given}\""))
            .remedy(format!("use {}", quoted.join(" or ")))
            .into()
    })
}

/// A file name of the deck; relative ones start in `folder`, one of the request's. An ending is added where it is missing.
///
/// # Errors
/// `missing-key` for an empty name.
pub(super) fn file_of(settings: &Settings, key: &str, folder: &Path, ending: &str) -> Result<PathBuf> {
    let name = settings.get_str(key)?;
    if name.is_empty() {
        return Err(settings.error(key, "missing-key", format!("\"{key}\" must name a file")).into());
    }
    let path = folder.join(name);
    Ok(if ending.is_empty() || name.ends_with(ending) { path } else { append(&path, ending) })
}

/// A path with text appended to its last name.
pub(super) fn append(path: &Path, text: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(text);
    PathBuf::from(name)
}

/// Warns of keys that are accepted and have no effect here.
pub(super) fn warn_unused(settings: &Settings, key: &str, why: &str) -> Diagnostic {
    let last = key.rsplit('.').next().unwrap_or(key);
    Diagnostic::warning("unused-key", format!("\"{last}\" of {}: {why}", settings.name())).at(settings.key_place(key))
}
