//! Values by step: amplitudes, ramps from step to step, and what a later step changes.

use std::collections::{BTreeMap, BTreeSet};

use crate::history::History;
use crate::mesh::Step;

/// Relative length of the ramp that stands for a jump.
const JUMP: f64 = 1e-9;
/// Parts of a segment of an amplitude of velocities: its integral is a parabola.
const PARTS: usize = 10;

/// A table of factors over time.
#[derive(Debug, Clone)]
pub(super) struct Amplitude {
    pub table: History,
    /// Whether its times are those of the analysis; those of the step otherwise.
    pub is_total: bool,
    /// Whether it holds values; factors otherwise.
    pub is_absolute: bool,
}

/// A value that a card gives in a step.
#[derive(Debug, Clone)]
pub(super) struct Entry {
    /// From 1; 0 stands before all steps.
    pub step: usize,
    pub amplitude: Option<String>,
    pub value: f64,
    /// Whether it is a velocity.
    pub is_rate: bool,
}

/// Steps of the file, and its amplitudes by name in capitals.
#[derive(Debug, Default)]
pub(super) struct Times {
    pub steps: Vec<Step>,
    /// Steps whose loads act in full from the start.
    pub instant: BTreeSet<usize>,
    pub amplitudes: BTreeMap<String, Amplitude>,
}

/// Values of a quantity by target.
#[derive(Debug)]
pub(super) struct Schedule<K> {
    entries: BTreeMap<K, Vec<Entry>>,
    /// Steps that drop all values of the steps before.
    renewed: BTreeSet<usize>,
    /// Whether several values of one step add up; the last counts otherwise.
    adds: bool,
}

/// A value over time, from its first step on.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Course {
    pub value: History,
    pub start: f64,
    pub end: Option<f64>,
}

impl<K: Ord + Clone> Schedule<K> {
    pub(super) fn new(adds: bool) -> Self {
        Self { entries: BTreeMap::new(), renewed: BTreeSet::new(), adds }
    }

    pub(super) fn add(&mut self, target: K, entry: Entry) {
        let all = self.entries.entry(target).or_default();
        if !self.adds {
            all.retain(|own| own.step != entry.step);
        }
        all.push(entry);
    }

    /// Drops the values of earlier steps at the start of this one.
    pub(super) fn renew(&mut self, step: usize) {
        self.renewed.insert(step);
    }

    /// The value of each target over time.
    pub(super) fn courses(&self, times: &Times) -> Vec<(K, Course)> {
        self.entries.iter().map(|(target, entries)| (target.clone(), self.course(entries, times))).collect()
    }

    fn course(&self, entries: &[Entry], times: &Times) -> Course {
        let of = |step: usize| entries.iter().filter(move |entry| entry.step == step);
        let before = of(0).fold(0.0, |sum, entry| sum + entry.value);
        let mut out = Course { value: History::constant(before), start: 0.0, end: None };
        let mut has_begun = of(0).next().is_some();
        for (at, step) in times.steps.iter().enumerate() {
            let now: Vec<&Entry> = of(at + 1).collect();
            match (now.is_empty(), has_begun) {
                (true, true) if self.renewed.contains(&(at + 1)) => {
                    // a load fades out, a support ends: of both the next card begins anew
                    out.value = out.value.then(step.start, [[step.end, 0.0]]);
                    out.end = out.end.or(Some(step.start));
                }
                (true, _) => {}
                (false, _) => {
                    if !has_begun {
                        out.start = step.start;
                    }
                    has_begun = true;
                    out.end = None;
                    out.value = in_step(&out.value, &now, step, times.instant.contains(&(at + 1)), times);
                }
            }
        }
        out
    }
}

/// The course up to a step, with the values of the step.
fn in_step(before: &History, now: &[&Entry], step: &Step, is_instant: bool, times: &Times) -> History {
    let length = step.end - step.start;
    let jump = step.start + JUMP * length;
    let first = before.at(step.start);
    let mut sum: Option<History> = None;
    let mut add = |part: History| sum = Some(sum.take().map_or(part.clone(), |sum| sum.plus(&part)));
    let is_by_amplitude = now.iter().any(|entry| entry.amplitude.is_some() || entry.is_rate);
    let plain: Vec<f64> =
        now.iter().filter(|entry| entry.amplitude.is_none() && !entry.is_rate).map(|entry| entry.value).collect();
    if !plain.is_empty() {
        let target: f64 = plain.iter().sum();
        let from = if is_by_amplitude { 0.0 } else { first };
        let start = if is_instant { target } else { from };
        add(History::of(vec![[step.start, start], [step.end, target]]));
    }
    for entry in now.iter().filter(|entry| entry.amplitude.is_some() || entry.is_rate) {
        let factors = entry.amplitude.as_ref().and_then(|name| times.amplitudes.get(name));
        let table = factors.map_or_else(
            || History::constant(entry.value),
            |factors| {
                let shift = if factors.is_total { 0.0 } else { step.start };
                let scale = if factors.is_absolute { 1.0 } else { entry.value };
                History::of(factors.table.points().iter().map(|[t, v]| [t + shift, v * scale]).collect())
            },
        );
        let mut instants: Vec<f64> = table.points().iter().map(|point| point[0]).collect();
        instants.retain(|time| *time > step.start && *time < step.end);
        instants.insert(0, step.start);
        instants.push(step.end);
        let points: Vec<[f64; 2]> = if entry.is_rate {
            integral(&table, &instants, first)
        } else {
            instants.iter().map(|&time| [time, table.at(time)]).collect()
        };
        add(History::of(points));
    }
    let sum = sum.unwrap_or_else(|| before.clone());
    let mut points = sum.points().to_vec();
    if points[0][1] == first {
        points.remove(0);
    } else {
        points[0][0] = jump;
    }
    before.then(step.start, points)
}

/// Positions by velocities, from `first` at the first instant.
fn integral(table: &History, instants: &[f64], first: f64) -> Vec<[f64; 2]> {
    let mut out = vec![[instants[0], first]];
    let mut position = first;
    for two in instants.windows(2) {
        let is_even = table.at(two[0]) == table.at(two[1]);
        let parts = if is_even { 1 } else { PARTS };
        let at = |part: usize| two[0] + (two[1] - two[0]) * part as f64 / parts as f64;
        for part in 0..parts {
            let (a, b) = (at(part), at(part + 1));
            position += 0.5 * (b - a) * (table.at(a) + table.at(b));
            out.push([b, position]);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times() -> Times {
        let step = |start, end| Step { start, end, increment: None };
        let table = History::of(vec![[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]]);
        let amplitude = Amplitude { table, is_total: false, is_absolute: false };
        Times {
            steps: vec![step(0.0, 1.0), step(1.0, 3.0)],
            instant: BTreeSet::new(),
            amplitudes: BTreeMap::from([("A".to_owned(), amplitude)]),
        }
    }

    fn course(adds: bool, entries: &[(usize, Option<&str>, f64, bool)]) -> Course {
        let mut schedule = Schedule::new(adds);
        for &(step, amplitude, value, is_rate) in entries {
            schedule.add(1, Entry { step, amplitude: amplitude.map(str::to_owned), value, is_rate });
        }
        schedule.courses(&times()).remove(0).1
    }

    #[test]
    fn loads_ramp_from_step_to_step() {
        let load = course(true, &[(1, None, 4.0, false), (1, None, 2.0, false), (2, None, 10.0, false)]);
        assert_eq!([0.5, 1.0, 2.0, 3.0].map(|time| load.value.at(time)), [3.0, 6.0, 8.0, 10.0]);
        let held = course(false, &[(2, None, 4.0, false), (2, None, 2.0, false)]);
        assert_eq!((held.start, held.value.at(2.0), held.value.at(3.0)), (1.0, 1.0, 2.0));
    }

    #[test]
    fn amplitudes_are_those_of_the_time_of_a_step() {
        let load = course(true, &[(1, Some("A"), 10.0, false)]);
        assert_eq!([0.25, 0.5, 0.75, 1.0, 2.0].map(|time| load.value.at(time)), [5.0, 10.0, 5.0, 0.0, 0.0]);
    }

    #[test]
    fn velocities_move_on_from_the_position_before() {
        let held = course(false, &[(1, None, 3.0, false), (2, None, 0.5, true)]);
        assert_eq!([1.0, 2.0, 3.0].map(|time| held.value.at(time)), [3.0, 3.5, 4.0]);
        let held = course(false, &[(1, Some("A"), 8.0, true)]);
        // the integral of a triangle of height 8 over 1
        assert!((held.value.at(1.0) - 4.0).abs() < 1e-12 && (held.value.at(0.25) - 0.5).abs() < 0.02);
    }
}
