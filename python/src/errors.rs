//! Errors as JSON, for Python to make exceptions of.

use serde_json::{Value, json};
use zelus::Error;
use zelus::core::diagnostics::Diagnostic;

/// Code, severity, fact, remedy and place of a problem.
pub(crate) fn problem(problem: &Diagnostic) -> Value {
    let place = problem.place.as_ref();
    json!({
        "code": problem.code,
        "severity": format!("{:?}", problem.severity).to_lowercase(),
        "fact": problem.fact,
        "remedy": problem.remedy,
        "file": place.map(|place| place.file.display().to_string()),
        "line": place.map_or(0, |place| place.line),
        "column": place.map_or(0, |place| place.column),
    })
}

/// The kind of an error, its text and its problems.
pub(crate) fn error(error: &Error) -> String {
    let (kind, problems) = match error {
        Error::Input(problems) => ("input", problems.iter().map(problem).collect()),
        Error::NotConverged(_) => ("not_converged", Vec::new()),
        Error::System(_) => ("system", Vec::new()),
    };
    json!({ "kind": kind, "text": error.to_string(), "problems": problems }).to_string()
}
