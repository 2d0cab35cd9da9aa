//! Faults of a mesh file, line by line.

use std::path::Path;

use crate::diagnostics::{Diagnostic, Place, Report, Result};

/// The problems of one file, up to a number a user may want to see.
pub(super) struct Problems<'a> {
    path: &'a Path,
    report: Report,
}

impl<'a> Problems<'a> {
    const CAP: usize = 50;

    /// None yet, in the file at `path`.
    pub(super) fn new(path: &'a Path) -> Self {
        Self { path, report: Report::new() }
    }

    /// Whether no more are looked for.
    pub(super) fn full(&self) -> bool {
        self.report.diagnostics().len() > Self::CAP
    }

    /// Adds a fault at a line.
    pub(super) fn push(&mut self, line: u32, diagnostic: Diagnostic) {
        if self.report.diagnostics().len() == Self::CAP {
            let fact = format!("more than {} problems; the rest of the file is not looked at", Self::CAP);
            self.report.push(Diagnostic::error("too-many-problems", fact).at(Place::file(self.path)));
        } else if !self.full() {
            self.report.push(diagnostic.at(Place::at(self.path, line, 0)));
        }
    }

    /// Adds an error at a line.
    pub(super) fn error(&mut self, line: u32, code: &'static str, fact: impl Into<String>) {
        self.push(line, Diagnostic::error(code, fact));
    }

    /// The warnings.
    ///
    /// # Errors
    /// All problems, if one is an error.
    pub(super) fn finish(self) -> Result<Vec<Diagnostic>> {
        self.report.finish()
    }
}
