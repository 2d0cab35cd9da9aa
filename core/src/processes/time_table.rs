//! A table over time that a process reads while it acts.

use crate::diagnostics::{Diagnostic, Place};
use crate::model::Table;
use crate::parameters::Interval;

/// A table over TIME, and when it is read.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeTable {
    /// Name of its file, as the deck gives it.
    pub name: String,
    /// Where the deck names it.
    pub place: Place,
    /// Last time of the table, and whether its values change there: beyond it they go on with the last slope.
    pub end: (f64, bool),
    /// When its process acts.
    pub interval: Interval,
}

/// Share of the run by which a table may end early.
const SHORT: f64 = 1e-9;

impl TimeTable {
    /// The use of a table; `None` for one of a single row, which is a constant.
    pub fn new(name: &str, place: Place, table: &Table, interval: Interval) -> Option<Self> {
        let [.., before, last] = table.points.as_slice() else { return None };
        Some(Self { name: name.to_owned(), place, end: (last[0], before[1] != last[1]), interval })
    }

    /// The warning that it ends before the last step of a run from `start` to `end` that reads it.
    pub fn ends_early(&self, [start, end]: [f64; 2]) -> Option<Diagnostic> {
        let (last, changes) = self.end;
        let needed = end.min(self.interval.end);
        let acts = self.interval.begin <= end && needed > start;
        if !acts || last >= needed - SHORT * (end - start) {
            return None;
        }
        let until = if needed < end { "its process acts" } else { "the run goes on" };
        let follows = if changes { "goes on with the last slope" } else { "keeps the last value" };
        let fact = format!(
            "the table {} ends at time {last}, and {until} until {needed}: beyond its end the value {follows}",
            self.name
        );
        let remedy = "add a row for the end, or let \"interval\" of the process end with the table";
        Some(Diagnostic::warning("table-ends-early", fact).at(self.place.clone()).remedy(remedy))
    }
}
