//! Digests of the files that decide results beside deck and mesh: materials, tables and what processes read.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::diagnostics::{Diagnostic, Place, Result};

/// Length and checksum of each file, by its name from the folder of the deck.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Contents(BTreeMap<PathBuf, [u64; 2]>);

impl Contents {
    /// Present contents of these files; a file that cannot be read counts as empty, and its reader reports it.
    pub(super) fn of(files: &[PathBuf], folder: &Path) -> Self {
        let digest = |file: &PathBuf| {
            let bytes = std::fs::read(file).unwrap_or_default();
            let name = file.strip_prefix(folder).unwrap_or(file).to_owned();
            (name, [bytes.len() as u64, u64::from(crc32fast::hash(&bytes))])
        };
        Self(files.iter().map(digest).collect())
    }

    /// Whether the files are those of the saved run.
    ///
    /// # Errors
    /// The first one that has changed since, by name.
    pub(super) fn check(&self, saved: &Self) -> Result<()> {
        let changed = self.0.iter().find(|(name, digest)| saved.0.get(*name).is_some_and(|before| before != *digest));
        let Some((name, _)) = changed else { return Ok(()) };
        let fact = format!("{} has changed since the run was saved", name.display());
        let remedy = "bring its content back, or run the deck from its start";
        Err(Diagnostic::error("saved-run", fact).at(Place::file(name)).remedy(remedy).into())
    }
}
