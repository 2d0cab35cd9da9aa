//! A table over time that a process reads while it acts.

use crate::diagnostics::{Diagnostic, Place, counted};
use crate::model::Table;
use crate::parameters::Interval;

/// A table over TIME, and when it is read.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeTable {
    /// Name of its file, as the deck gives it.
    pub name: String,
    /// Where the deck names it.
    pub place: Place,
    /// First time of the table, and whether its values change there: before it they continue with the first slope.
    pub begin: (f64, bool),
    /// Last time of the table, and whether its values change there: beyond it they continue with the last slope.
    pub end: (f64, bool),
    /// The warning that its rows are not in order, where that is so.
    pub fault: Option<Diagnostic>,
    /// Cells that are empty, and count as zero since the deck does not say by what they are replaced.
    pub missing: usize,
    /// When its process acts.
    pub interval: Interval,
}

/// Share of the run by which a table may end early.
const SHORT: f64 = 1e-9;

impl TimeTable {
    /// The use of a table; `None` for one of a single row, which is a constant.
    pub fn new(name: &str, place: Place, table: &Table, interval: Interval) -> Option<Self> {
        let [.., before, last] = table.points.as_slice() else { return None };
        let (first, second) = (table.points[0], table.points[1]);
        let begin = (first[0], first[1] != second[1]);
        let end = (last[0], before[1] != last[1]);
        Some(Self { name: name.to_owned(), place, begin, end, fault: None, missing: 0, interval })
    }

    /// The warning that it has empty cells.
    pub fn lacks_values(&self) -> Option<Diagnostic> {
        let Self { name, missing, .. } = self;
        let cells = counted(*missing, "empty cell, which counts", "empty cells, which count");
        let fact = format!("the table {name} has {cells} as 0");
        let problem = Diagnostic::warning("missing-values", fact).at(self.place.clone());
        (*missing > 0).then(|| problem.remedy("write the values, or give \"na_replace\", the number in their place"))
    }

    /// The warning that it begins after the first of the steps that read it, in a run with steps that end at `first` to `end`.
    pub fn begins_late(&self, [first, end]: [f64; 2]) -> Option<Diagnostic> {
        let (begin, changes) = self.begin;
        let needed = first.max(self.interval.begin);
        let acts = needed <= end.min(self.interval.end);
        if !acts || begin <= needed + SHORT * (end - needed).abs() {
            return None;
        }
        let follows = if changes { "follows the first slope" } else { "is the first one" };
        let fact = format!(
            "the table {} begins at time {begin}, and is read from time {needed} on: before its first row the value {follows}",
            self.name
        );
        let remedy = "add a row for the start, or let \"interval\" of the process begin with the table";
        Some(Diagnostic::warning("table-begins-late", fact).at(self.place.clone()).remedy(remedy))
    }

    /// The warning that it ends before the last step of a run from `start` to `end` that reads it.
    pub fn ends_early(&self, [start, end]: [f64; 2]) -> Option<Diagnostic> {
        let (last, changes) = self.end;
        let needed = end.min(self.interval.end);
        let acts = self.interval.begin <= end && needed > start;
        if !acts || last >= needed - SHORT * (end - start) {
            return None;
        }
        let until = if needed < end { "its process acts" } else { "the run continues" };
        let follows = if changes { "continues with the last slope" } else { "keeps the last value" };
        let fact = format!(
            "the table {} ends at time {last}, and {until} until {needed}: beyond its end the value {follows}",
            self.name
        );
        let remedy = "add a row for the end, or let \"interval\" of the process end with the table";
        Some(Diagnostic::warning("table-ends-early", fact).at(self.place.clone()).remedy(remedy))
    }
}
