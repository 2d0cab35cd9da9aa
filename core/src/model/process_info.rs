//! Data of a step that the whole model shares: time, counters and named numbers.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::solver_info::SolverInfo;
use super::step_mark::StepMark;
use crate::names;

/// Time, step and iteration counters, and named values set by processes.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ProcessInfo {
    /// Time at the end of the step.
    pub time: f64,
    /// Length of the step.
    pub delta_time: f64,
    /// Number of the step, from 1; 0 before the first.
    pub step: usize,
    /// Newton iterations of the step so far: linear solves done or under way.
    pub nl_iteration: usize,
    /// Dimensions of the problem: 2 or 3.
    pub domain_size: usize,
    /// Named numbers, e.g. INITIAL_PENALTY, SCALE_FACTOR.
    #[serde(deserialize_with = "names::read_keys")]
    pub values: BTreeMap<&'static str, f64>,
    /// Named marks, e.g. ADAPT_PENALTY.
    #[serde(deserialize_with = "names::read_keys")]
    pub marks: BTreeMap<&'static str, bool>,
    /// Facts about the solver.
    pub solver: SolverInfo,
}

impl ProcessInfo {
    /// The named number, or `default`.
    pub fn value_or(&self, name: &str, default: f64) -> f64 {
        self.values.get(name).copied().unwrap_or(default)
    }

    /// Whether a mark is set.
    pub fn has(&self, mark: StepMark) -> bool {
        self.is(mark.name())
    }

    /// Sets a mark, or takes it away.
    pub fn set(&mut self, mark: StepMark, is_set: bool) {
        self.marks.insert(mark.name(), is_set);
    }

    /// Whether the named mark is set.
    pub fn is(&self, name: &str) -> bool {
        self.marks.get(name) == Some(&true)
    }
}
