//! Problems of a stage's preparation, agreed on by all ranks.

use crate::communication::Ranks;
use crate::diagnostics::{Diagnostic, Error, Report, Result};

/// The error that ends the preparation: all errors so far, or the plain fact where none is known.
pub(super) fn as_error(mut problems: Report) -> Error {
    if !problems.has_errors() {
        problems.push(Diagnostic::error("deck", "the deck cannot be prepared"));
    }
    problems.finish().expect_err("it has errors")
}

/// The problems of all ranks, each once; collective.
///
/// # Errors
/// All of them, when one on any rank is an error.
pub(super) fn problems_of_all(ranks: &Ranks, problems: Report) -> Result<Report> {
    let (Ok(own) | Err(Error::Input(own))) = problems.finish() else { unreachable!("problems are of the input") };
    let mut all = Report::new();
    ranks.problems_of_all(own).into_iter().for_each(|problem| all.push(problem));
    if all.has_errors() { Err(as_error(all)) } else { Ok(all) }
}

/// The problems so far: several ranks stop at the first errors, one rank goes on to find all there are. Collective.
///
/// # Errors
/// All of them, when one is an error and there are several ranks.
pub(super) fn problems_of_ranks(ranks: &Ranks, problems: Report) -> Result<Report> {
    if ranks.size() > 1 { problems_of_all(ranks, problems) } else { Ok(problems) }
}
