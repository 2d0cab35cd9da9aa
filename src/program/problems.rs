//! The problems of a deck as JSON, for programs that read them.

use serde_json::{Value, json};
use zelus_core::Error;
use zelus_core::diagnostics::{Diagnostic, Severity};
use zelus_core::strategies::Monitor;

/// Gathers problems and says nothing.
#[derive(Default)]
pub(super) struct Problems(Vec<Diagnostic>);

impl Monitor for Problems {
    fn warn(&mut self, warning: &Diagnostic) {
        self.0.push(warning.clone());
    }
}

impl Problems {
    /// All of them and those of `error`, each once, with the exit code of the program.
    pub(super) fn json(mut self, error: Option<&Error>) -> Value {
        match error {
            Some(Error::Input(problems)) => {
                let new: Vec<Diagnostic> = problems.iter().filter(|own| !self.0.contains(own)).cloned().collect();
                self.0.extend(new);
            }
            Some(Error::NotConverged(fact)) => self.0.push(Diagnostic::error("not-converged", fact.clone())),
            Some(Error::System(fact)) => self.0.push(Diagnostic::error("system", fact.clone())),
            None => {}
        }
        let problems: Vec<Value> = self.0.iter().map(one).collect();
        json!({"exit_code": error.map_or(0, Error::exit_code), "problems": problems})
    }
}

fn one(problem: &Diagnostic) -> Value {
    let severity = match problem.severity {
        Severity::Note => "note",
        Severity::Warning => "warning",
        Severity::Error => "error",
    };
    let place = problem.place.as_ref();
    json!({
        "severity": severity,
        "code": problem.code,
        "file": place.map(|place| place.file.to_string_lossy()),
        "line": place.map(|place| place.line),
        "column": place.map(|place| place.column),
        "fact": problem.fact,
        "remedy": problem.remedy,
    })
}
