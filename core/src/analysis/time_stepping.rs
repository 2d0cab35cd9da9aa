//! Lengths of the steps, as the deck gives them.

use crate::diagnostics::{Diagnostic, Result};
use crate::model::Table;
use crate::parameters::{Interval, Node};

/// The rule that gives the next step's length from the present time.
#[derive(Debug, Clone, PartialEq)]
pub enum TimeStepping {
    /// `time_step`: always the same.
    Constant(f64),
    /// `time_step_table`: piecewise linear in time.
    Table(Table),
    /// `time_step_intervals`: the first interval, by name, that contains the time.
    Intervals(Vec<(Interval, f64)>),
}

impl TimeStepping {
    /// From the deck's `time_stepping` object.
    ///
    /// # Errors
    /// No rule, or one that cannot be used.
    pub fn from_node(node: &Node) -> Result<Self> {
        if let Some(step) = node.get("time_step") {
            let length = step.f64()?;
            if !(length > 0.0 && length.is_finite()) {
                return Err(Diagnostic::error("time-step", format!("\"time_step\" is {length}, it must be positive"))
                    .at(node.key_place("time_step"))
                    .remedy("write the length of a step, e.g. 0.1")
                    .into());
            }
            return Ok(Self::Constant(length));
        }
        if let Some(table) = node.get("time_step_table") {
            let mut points = Vec::new();
            for row in table.array()? {
                match row.array()? {
                    [time, step] => points.push([time.f64()?, step.f64()?]),
                    _ => {
                        return Err(Diagnostic::error("time-step", "a row of \"time_step_table\" is [time, step]")
                            .at(row.place())
                            .into());
                    }
                }
            }
            if !points.is_empty() {
                return Ok(Self::Table(Table::new(points)));
            }
        }
        if let Some(intervals) = node.get("time_step_intervals") {
            let mut rules = Vec::new();
            for member in intervals.object()?.iter() {
                let interval = Interval::from_node(member.node.require("interval")?)?;
                rules.push((interval, member.node.require("time_step")?.f64()?));
            }
            if !rules.is_empty() {
                return Ok(Self::Intervals(rules));
            }
        }
        Err(Diagnostic::error("time-step", "\"time_stepping\" gives no step length")
            .at(node.place())
            .remedy("give \"time_step\", \"time_step_table\" or \"time_step_intervals\"")
            .into())
    }

    /// Length of the step that begins at `time`.
    ///
    /// # Errors
    /// A time that no interval contains, or a table that gives no positive length.
    pub fn next(&self, time: f64) -> Result<f64> {
        let length = match self {
            Self::Constant(length) => *length,
            Self::Table(table) => table.value(time),
            Self::Intervals(rules) => {
                let found = rules.iter().find(|(interval, _)| interval.contains(time));
                found.map_or(f64::NAN, |(_, length)| *length)
            }
        };
        if length > 0.0 {
            Ok(length)
        } else {
            Err(Diagnostic::error("time-step", format!("\"time_stepping\" gives no positive step at time {time}"))
                .into())
        }
    }
}
