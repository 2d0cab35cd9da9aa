//! Seconds that a strategy spends beside assembly, by phase.

use std::collections::BTreeMap;
use std::time::Instant;

/// Seconds by phase.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Phases {
    seconds: BTreeMap<&'static str, f64>,
}

impl Phases {
    /// Adds seconds to a phase.
    pub fn add(&mut self, phase: &'static str, seconds: f64) {
        *self.seconds.entry(phase).or_default() += seconds;
    }

    /// Adds the time since `start`.
    pub fn since(&mut self, phase: &'static str, start: Instant) {
        self.add(phase, start.elapsed().as_secs_f64());
    }

    /// The phases with their seconds.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, f64)> {
        self.seconds.iter().map(|(phase, seconds)| (*phase, *seconds))
    }
}
