//! The warnings of a run, said once more at its end.

use std::collections::BTreeMap;

use zelus_core::diagnostics::{Diagnostic, Severity};

/// Warnings by code: their number, and the text of the first.
#[derive(Debug, Default)]
pub(super) struct Warnings(BTreeMap<&'static str, (usize, String)>);

impl Warnings {
    pub(super) fn push(&mut self, problem: &Diagnostic) {
        if problem.severity == Severity::Warning {
            let place = problem.place.iter().map(|place| format!("{place}: ")).collect::<String>();
            let entry = self.0.entry(problem.code).or_insert_with(|| (0, format!("{place}{}", problem.fact)));
            entry.0 += 1;
        }
    }

    /// A line for each code, below one that counts; nothing where there was none.
    pub(super) fn lines(&self) -> Vec<String> {
        let all: usize = self.0.values().map(|(count, _)| count).sum();
        let head = (all > 0).then(|| format!("{all} warning{}:", if all == 1 { "" } else { "s" }));
        let each = self.0.iter().map(|(code, (count, first))| match count {
            1 => format!("  {code}: {first}"),
            _ => format!("  {code}, {count} times, the first: {first}"),
        });
        head.into_iter().chain(each).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warnings_are_grouped_by_code_and_counted() {
        let mut warnings = Warnings::default();
        assert!(warnings.lines().is_empty());
        for fact in ["one", "two"] {
            warnings.push(&Diagnostic::warning("unread", fact).remedy("remove it"));
        }
        warnings.push(&Diagnostic::warning("energy", "won"));
        warnings.push(&Diagnostic::note("told", "only"));
        assert_eq!(warnings.lines(), ["3 warnings:", "  energy: won", "  unread, 2 times, the first: one"]);
    }
}
