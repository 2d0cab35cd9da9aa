//! In which steps output is written.

use super::part_path::one_of;
use crate::diagnostics::Result;
use crate::model::ProcessInfo;
use crate::parameters::Settings;

/// Unit of intervals of output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum IntervalUnit {
    Step,
    Time,
}

/// Output every so many steps or so much time; compares exactly, as Kratos does.
///
/// Steps of 0.1 with an interval of 0.2 in time are thus written at 0.2, 0.4, 0.7, 0.9: the sum of floats decides.
#[derive(Debug, Clone)]
pub(super) struct OutputControl {
    pub(super) unit: IntervalUnit,
    interval: f64,
    /// When output is wanted next.
    pub(super) next: f64,
}

impl OutputControl {
    /// Reads `output_control_type` and `output_interval` below `prefix`.
    pub(super) fn new(settings: &Settings, prefix: &str) -> Result<Self> {
        let kind = one_of(settings, &format!("{prefix}output_control_type"), &["step", "time"])?;
        let interval = settings.get_f64(&format!("{prefix}output_interval"))?;
        let mut control = Self { unit: [IntervalUnit::Step, IntervalUnit::Time][kind], interval, next: 0.0 };
        control.advance(0.0);
        Ok(control)
    }

    /// Whether this step is one to write.
    pub(super) fn wants(&self, info: &ProcessInfo) -> bool {
        self.now(info) >= self.next
    }

    /// After output was written: when it is wanted next.
    pub(super) fn written(&mut self, info: &ProcessInfo) {
        self.advance(self.now(info));
    }

    fn advance(&mut self, now: f64) {
        if self.interval > 0.0 {
            self.next = ((now / self.interval).trunc() + 1.0) * self.interval;
        }
    }

    fn now(&self, info: &ProcessInfo) -> f64 {
        match self.unit {
            IntervalUnit::Step => info.step as f64,
            IntervalUnit::Time => info.time,
        }
    }
}

/// The counter of the JSON processes: time since the last output, compared strictly.
///
/// A frequency of 0.1 with steps of 0.1 acts at 0.2, 0.3, 0.5, 0.7: the sum of floats decides, as in Kratos.
#[derive(Debug, Clone)]
pub(super) struct TimeCounter {
    frequency: f64,
    /// Time since the last output.
    pub(super) counter: f64,
}

impl TimeCounter {
    pub(super) fn new(settings: &Settings) -> Result<Self> {
        Ok(Self { frequency: settings.get_f64("time_frequency")?, counter: 0.0 })
    }

    /// Counts a step; whether it is one to act in.
    pub(super) fn acts(&mut self, info: &ProcessInfo) -> bool {
        self.counter += info.delta_time;
        let acts = self.counter > self.frequency;
        if acts {
            self.counter = 0.0;
        }
        acts
    }
}
