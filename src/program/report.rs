//! The file that `--report` names.

use std::io::Write;
use std::path::{Path, PathBuf};

use zelus_core::analysis::RunReport;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::io::{FileUse, check_files, replace_own_file};
use zelus_core::{Error, Result};

/// A key that every report has.
const MARK: &str = "\"laid_defaults\"";

/// Refuses a file that the command line names as an output: in no folder, or one that is an input or cannot be written.
///
/// # Errors
/// The reason, before anything is read.
pub(super) fn check_output(what: &str, path: &Path, inputs: &[&Path]) -> Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        let missing = format!("cannot write {what} to {}: there is no folder {}", path.display(), folder.display());
        return Err(Error::System(missing));
    }
    let mut files: Vec<FileUse> = inputs.iter().map(|input| FileUse::Reads((*input).to_owned())).collect();
    files.push(FileUse::Writes(path.to_owned()));
    let problems = check_files(&files);
    if problems.is_empty() { Ok(()) } else { Err(Error::Input(problems)) }
}

/// Refuses to replace a file that an earlier run has not written: one without the `mark` that all such files have.
///
/// # Errors
/// The stranger's file.
pub(super) fn check_earlier(what: &str, path: &Path, mark: &str) -> Result<()> {
    let is_strange = |text: Vec<u8>| !text.is_empty() && !String::from_utf8_lossy(&text).contains(mark);
    if !std::fs::read(path).is_ok_and(is_strange) {
        return Ok(());
    }
    let fact = format!("{} is no {what} of an earlier run, and would be replaced", path.display());
    let problem = Diagnostic::error("output-file", fact);
    Err(problem.remedy(format!("give the {what} another name, or remove the file")).into())
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
        let path = &self.0;
        check_output("the report", path, &[deck])?;
        check_earlier("report", path, MARK)
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
