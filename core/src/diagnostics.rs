//! Errors and warnings with place, fact and remedy; one error type for the whole framework.
//!
//! Problems of the input are gathered as [`Diagnostic`]s in a [`Report`] and shown together; everything that stops a
//! run is an [`Error`], whose variant decides the exit code of the program.

use std::fmt;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use zelus_linear_algebra::WrongState;

use crate::names::{self, Name};

/// A position in an input file; `line` and `column` count from 1, 0 means "the file as a whole".
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Place {
    /// The file, as the user named it.
    pub file: PathBuf,
    /// Line from 1; 0 for the whole file.
    pub line: u32,
    /// Column from 1, counted in characters; 0 for the whole line.
    pub column: u32,
}

/// Start of the places of keys that are set by the command line.
const SET: &str = "--set ";

impl Place {
    /// The option of the command line that sets a key.
    pub fn command_line(key: &str) -> Self {
        Self::file(format!("{SET}{key}"))
    }

    /// Whether it is an option of the command line.
    pub fn is_of_command_line(&self) -> bool {
        self.file.to_string_lossy().starts_with(SET)
    }

    /// A whole file.
    pub fn file(path: impl AsRef<Path>) -> Self {
        Self { file: path.as_ref().to_owned(), line: 0, column: 0 }
    }

    /// A line (and column, 0 if unknown) of a file.
    pub fn at(path: impl AsRef<Path>, line: u32, column: u32) -> Self {
        Self { file: path.as_ref().to_owned(), line, column }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if self.line > 0 {
            write!(f, ":{}", self.line)?;
            if self.column > 0 {
                write!(f, ":{}", self.column)?;
            }
        }
        Ok(())
    }
}

/// Whether a problem stops the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Severity {
    /// Worth knowing, nothing to do about it.
    Note,
    /// The run continues; the log and the report of the run show it.
    Warning,
    /// The run does not start, or ends.
    Error,
}

/// One problem: its name, place, fact and remedy.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Diagnostic {
    /// Whether it stops the run.
    pub severity: Severity,
    /// Short stable name in kebab-case, e.g. `unknown-key`.
    #[serde(deserialize_with = "names::read")]
    pub code: Name,
    /// Where, when an input file is to blame.
    pub place: Option<Place>,
    /// The fact, in one sentence without a final stop.
    pub fact: String,
    /// The remedy.
    pub remedy: Option<String>,
}

impl Diagnostic {
    /// An error without place or remedy; add them with [`Diagnostic::at`] and [`Diagnostic::remedy`].
    pub fn error(code: &'static str, fact: impl Into<String>) -> Self {
        Self { severity: Severity::Error, code, place: None, fact: fact.into(), remedy: None }
    }

    /// A warning without place or remedy.
    pub fn warning(code: &'static str, fact: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(code, fact) }
    }

    /// A note without place or remedy.
    pub fn note(code: &'static str, fact: impl Into<String>) -> Self {
        Self { severity: Severity::Note, ..Self::error(code, fact) }
    }

    /// The same problem with its place.
    #[must_use]
    pub fn at(mut self, place: impl Into<Option<Place>>) -> Self {
        self.place = place.into();
        self
    }

    /// The same problem with a remedy.
    #[must_use]
    pub fn remedy(mut self, remedy: impl Into<String>) -> Self {
        self.remedy = Some(remedy.into());
        self
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = match self.severity {
            Severity::Note => "note",
            Severity::Warning => "warning",
            Severity::Error => "error",
        };
        write!(f, "{kind}[{}]", self.code)?;
        if let Some(place) = &self.place {
            write!(f, " {place}")?;
        }
        write!(f, ": {}", self.fact)?;
        if let Some(remedy) = &self.remedy {
            write!(f, "\n    {remedy}")?;
        }
        Ok(())
    }
}

/// Gathers problems, so that a user sees all of them at once.
#[derive(Debug, Clone, Default)]
pub struct Report {
    diagnostics: Vec<Diagnostic>,
}

impl Report {
    /// An empty report.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds one problem; the same one said twice is kept once.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        if !self.diagnostics.contains(&diagnostic) {
            self.diagnostics.push(diagnostic);
        }
    }

    /// Takes the value of `result`, or keeps its problems and gives `None`.
    pub fn absorb<T>(&mut self, result: Result<T>) -> Option<T> {
        result.map_err(|error| self.keep(error)).ok()
    }

    fn keep(&mut self, error: Error) {
        match error {
            Error::Input(problems) => problems.into_iter().for_each(|d| self.push(d)),
            other => self.push(Diagnostic::error("failed", other.to_string())),
        }
    }

    /// All problems so far, in the order they were met.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    /// Whether one of them stops the run.
    pub fn has_errors(&self) -> bool {
        self.diagnostics.iter().any(|d| d.severity == Severity::Error)
    }

    /// The warnings when nothing stops the run, else the error that holds every problem.
    ///
    /// # Errors
    /// [`Error::Input`] when at least one problem is an error.
    pub fn finish(self) -> Result<Vec<Diagnostic>> {
        if self.has_errors() { Err(Error::Input(self.diagnostics)) } else { Ok(self.diagnostics) }
    }
}

/// Everything that stops a run; the variant decides the exit code.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The deck is wrong: every problem found, with places (exit code 2).
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Input(Vec<Diagnostic>),
    /// A step did not converge; the steps accepted before it are on disk (exit code 3).
    #[error("{0}")]
    NotConverged(String),
    /// The machine, a file or a solver failed (exit code 4).
    #[error("{0}")]
    System(String),
}

impl Error {
    /// One input problem.
    pub fn input(diagnostic: Diagnostic) -> Self {
        Self::Input(vec![diagnostic])
    }

    /// The same error, where problems of the input that have no place get this one.
    #[must_use]
    pub fn at(mut self, place: &Place) -> Self {
        if let Self::Input(problems) = &mut self {
            problems.iter_mut().filter(|d| d.place.is_none()).for_each(|d| d.place = Some(place.clone()));
        }
        self
    }

    /// The exit code of the program: 2 bad input, 3 not converged, 4 system or solver.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Input(_) => 2,
            Self::NotConverged(_) => 3,
            Self::System(_) => 4,
        }
    }
}

impl From<Diagnostic> for Error {
    fn from(diagnostic: Diagnostic) -> Self {
        Self::input(diagnostic)
    }
}

impl From<WrongState> for Error {
    fn from(wrong: WrongState) -> Self {
        Diagnostic::error("saved-state", wrong.to_string()).remedy("it was saved by a run of another deck").into()
    }
}

/// Error: a saved state cannot be of the run that reads it.
pub fn unfit(fact: impl Into<String>) -> Error {
    Diagnostic::error("saved-state", fact).remedy("it was saved by a run of another deck, or it is forged").into()
}

/// Result of everything in the framework that can fail.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// A number with its noun and verb, as messages say it.
///
/// ```
/// use zelus_core::diagnostics::counted;
///
/// assert_eq!([1, 3].map(|count| counted(count, "node has", "nodes have")), ["1 node has", "3 nodes have"]);
/// ```
pub fn counted(count: usize, one: &str, several: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { several })
}

/// A point as messages name it: 7 significant digits, and 0 for round-off of the largest coordinate.
///
/// ```
/// use zelus_core::diagnostics::coordinates;
///
/// assert_eq!(coordinates([0.1 + 0.2, 2.0 / 3.0, -2e-16]), "(0.3, 0.6666667, 0)");
/// ```
pub fn coordinates(point: [f64; 3]) -> String {
    let largest = point.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let rounded = |x: f64| if x.abs() < 1e-12 * largest { 0.0 } else { format!("{x:.6e}").parse().unwrap_or(x) };
    let [x, y, z] = point.map(rounded);
    format!("({x}, {y}, {z})")
}

/// The names nearest to `wanted`, best first, at most three; for "did you mean".
pub fn nearest<'a>(wanted: &str, names: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let lower = wanted.to_lowercase();
    let mut scored: Vec<(f64, &str)> =
        names.into_iter().map(|name| (strsim::jaro_winkler(&lower, &name.to_lowercase()), name)).collect();
    scored.retain(|(score, _)| *score > 0.8);
    scored.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(b.1)));
    scored.dedup_by(|a, b| a.1 == b.1);
    // a name much farther than the best is no help
    let best = scored.first().map_or(0.0, |(score, _)| *score);
    scored.retain(|(score, _)| *score > best - 0.06);
    scored.into_iter().take(3).map(|(_, name)| name).collect()
}

/// `did you mean "a" or "b"?`, or `None` when nothing is near.
pub fn did_you_mean<'a>(wanted: &str, names: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let near = nearest(wanted, names);
    (!near.is_empty()).then(|| {
        let quoted: Vec<String> = near.iter().map(|name| format!("\"{name}\"")).collect();
        format!("did you mean {}?", quoted.join(" or "))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_come_first() {
        assert_eq!(nearest("DISPLACMENT", ["REACTION", "DISPLACEMENT"]), ["DISPLACEMENT"]);
        assert_eq!(did_you_mean("zzz", ["REACTION"]), None);
    }

    #[test]
    fn a_report_with_only_warnings_passes() {
        let mut report = Report::new();
        report.push(Diagnostic::warning("old-key", "x"));
        assert_eq!(report.clone().finish().unwrap().len(), 1);
        report.push(Diagnostic::error("bad", "y").at(Place::at("a.json", 3, 4)).remedy("z"));
        let error = report.finish().unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains("error[bad] a.json:3:4: y\n    z"));
    }
}
