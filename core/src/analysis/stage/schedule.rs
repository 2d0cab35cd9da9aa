//! The steps of a stage in time.

use super::super::cutting::Cutting;
use super::super::time_stepping::TimeStepping;

/// Times of a stage, and how it steps through them.
pub(super) struct Schedule {
    /// Time at which it starts.
    pub start_time: f64,
    /// Time at which it ends, after `start_time`.
    pub end_time: f64,
    /// Lengths of the steps.
    pub stepping: TimeStepping,
    /// How a step that fails is cut.
    pub cutting: Cutting,
}

impl Schedule {
    /// Start and end.
    pub fn interval(&self) -> [f64; 2] {
        [self.start_time, self.end_time]
    }

    /// End of the first step, where its length is known.
    pub fn first_step_end(&self) -> Option<f64> {
        let length = self.stepping.next(self.start_time).ok()?;
        Some(self.stepping.target(self.start_time, length, self.interval()).0)
    }
}
