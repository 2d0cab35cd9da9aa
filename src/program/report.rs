//! The file that `--report` names.

use std::io::Write;
use std::path::{Path, PathBuf};

use serde_json::Value;
use zelus_core::analysis::RunReport;
use zelus_core::io::{FileUse, Mark, check_files, replace_own_file};
use zelus_core::{Error, Result};

/// A key of every report, and of reports alone.
const MARK: Mark = Mark::Holds("\"kept_every\"");

/// Whether a value is the report of a run.
pub(super) fn is_report(value: &Value) -> bool {
    value.get("kept_every").is_some()
}

/// Refuses a file that the command line names as an output: in no folder, or one that is an input, cannot be written, or is not of an
/// earlier run, which has the mark.
///
/// # Errors
/// The reason, before anything is read.
pub(super) fn check_output(what: &str, path: &Path, inputs: &[&Path], mark: Mark) -> Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        let missing = format!("cannot write {what} to {}: there is no folder {}", path.display(), folder.display());
        return Err(Error::System(missing));
    }
    let mut files: Vec<FileUse> = inputs.iter().map(|input| FileUse::Reads((*input).to_owned())).collect();
    files.push(FileUse::Writes(path.to_owned(), mark));
    let problems = check_files(&files, 0);
    if problems.is_empty() { Ok(()) } else { Err(Error::Input(problems)) }
}

/// Makes a folder for results, where it is not there.
///
/// # Errors
/// A folder that cannot be made.
pub(super) fn made_folder(folder: &Path) -> Result<()> {
    let failed = |error| Error::System(format!("{}: cannot be made: {error}", folder.display()));
    std::fs::create_dir_all(folder).map_err(failed)
}

/// The report of a run, to be written at its end.
#[derive(Debug)]
pub(super) struct Report(pub PathBuf);

impl Report {
    /// Refuses a file that is the deck, is no report, or cannot be written.
    ///
    /// # Errors
    /// The reason, before anything is read.
    pub(super) fn check(&self, deck: &Path) -> Result<()> {
        check_output("the report", &self.0, &[deck], MARK)
    }

    /// Writes the report, unless the run has ended since files would have been lost.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub(super) fn write(&self, run: &RunReport, why: Option<&Error>) -> Result<()> {
        if let Some(Error::Input(problems)) = why
            && problems.iter().any(|problem| problem.code == "output-file")
        {
            return Ok(());
        }
        let text = serde_json::to_string_pretty(run).map_err(|e| Error::System(format!("report: {e}")))?;
        replace_own_file(&self.0, |file| file.write_all(text.as_bytes()))
    }
}
