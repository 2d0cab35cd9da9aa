//! The report of a run: sizes, convergence, times.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::diagnostics::Error;
use crate::model::{ModelPart, NumberedBodies};
use crate::processes::{Extreme, Extremes};
use crate::strategies::{Balance, StepRecord, SupportReaction, body_of};

/// Most steps of which records are kept.
const MOST_RECORDS: usize = 10_000;

/// Most bodies that a report names.
const MOST_BODIES: usize = 100;

/// Sizes of a problem.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sizes {
    /// Nodes.
    pub nodes: usize,
    /// Elements.
    pub elements: usize,
    /// Conditions.
    pub conditions: usize,
    /// Constraints.
    pub constraints: usize,
    /// Unknowns, fixed ones included.
    pub unknowns: usize,
}

/// A node with its initial position.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct NodePlace {
    /// Id of the node.
    pub node: usize,
    /// Initial position.
    pub position: [f64; 3],
}

/// A body of connected elements.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Body {
    /// Smallest id of its nodes.
    pub node: usize,
    /// Its smallest sub model part with elements; empty where there is none.
    pub name: String,
}

impl Body {
    /// The bodies of a part, none where there are more than a reader would tell apart; collective.
    pub(crate) fn all(part: &ModelPart) -> Vec<Self> {
        let bodies = NumberedBodies::of(part).first;
        if bodies.len() > MOST_BODIES {
            return Vec::new();
        }
        let named = |node: usize| {
            let own = part.nodes.find(node).filter(|&node| part.owns_node(node as usize));
            let name = own.and_then(|node| body_of(&part.tree, node)).map(str::to_owned);
            Self { node, name: part.ranks.first_to_say(name).unwrap_or_default() }
        };
        bodies.into_iter().map(named).collect()
    }
}

/// Report of a run, as written by `--report`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunReport {
    /// Version of the program.
    pub version: String,
    /// Name of the problem.
    pub problem: String,
    /// Program whose defaults hold where the deck names nothing; `None` for our own.
    pub like: Option<String>,
    /// The settings that this gave the deck, as `object.key = value`; reports of earlier builds name them `laid_defaults`.
    #[serde(alias = "laid_defaults")]
    pub defaults_from_kratos: Vec<String>,
    /// Stages run.
    pub stages: Vec<String>,
    /// Sizes of the last stage.
    pub sizes: Sizes,
    /// Accepted steps and failed attempts, in order; of more than 10,000 every `kept_every`-th step, and the last one.
    pub steps: Vec<StepRecord>,
    /// Number of steps for each kept record.
    pub kept_every: usize,
    /// Steps that converged, all.
    pub converged_steps: usize,
    /// Their iterations.
    pub iterations: usize,
    /// Exit code of the program: 0 done and converged, 2 bad input, 3 not converged, 4 system or solver failure, 5 stopped and
    /// saved.
    pub exit_code: u8,
    /// Why the run ended early, in words.
    pub errors: Vec<String>,
    /// Notes, in words.
    pub notes: Vec<String>,
    /// Warnings, in words.
    pub warnings: Vec<String>,
    /// Engine of the deck's linear solver.
    pub linear_solver: String,
    /// Numbers that interactions chose for the run, by name, e.g. penalty and scale factor of contact; of the last stage.
    pub parameters: BTreeMap<String, f64>,
    /// Seconds by phase.
    pub seconds: BTreeMap<String, f64>,
    /// Most bytes of memory that the process has held so far; 0 where the system does not say.
    #[serde(default)]
    pub memory: u64,
    /// Threads used.
    pub threads: usize,
    /// Files and folders a user would open.
    pub outputs: Vec<PathBuf>,
    /// Files that were read: deck, mesh, materials, tables; of the last stage.
    #[serde(default)]
    pub inputs: Vec<PathBuf>,
    /// The largest size at a node of each default output variable, by name: unknowns, reactions, contact results, and the largest
    /// value of scalars of the stress; at the end of a run that came to it.
    #[serde(default)]
    pub largest: BTreeMap<String, f64>,
    /// The smallest value at a node of scalars of the stress, by name: smallest principal stress, safety factor.
    #[serde(default)]
    pub smallest: BTreeMap<String, f64>,
    /// Nodes of these values, by name.
    #[serde(default)]
    pub places: BTreeMap<String, NodePlace>,
    /// Bodies of connected elements, of at most 100.
    #[serde(default)]
    pub bodies: Vec<Body>,
    /// Whether every step converged.
    pub converged: bool,
}

impl Default for RunReport {
    /// Nothing has run by this version.
    fn default() -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            problem: String::new(),
            like: None,
            defaults_from_kratos: Vec::new(),
            stages: Vec::new(),
            sizes: Sizes::default(),
            steps: Vec::new(),
            kept_every: 1,
            converged_steps: 0,
            iterations: 0,
            exit_code: 0,
            errors: Vec::new(),
            notes: Vec::new(),
            warnings: Vec::new(),
            linear_solver: String::new(),
            parameters: BTreeMap::new(),
            seconds: BTreeMap::new(),
            memory: 0,
            threads: 0,
            outputs: Vec::new(),
            inputs: Vec::new(),
            largest: BTreeMap::new(),
            smallest: BTreeMap::new(),
            places: BTreeMap::new(),
            bodies: Vec::new(),
            converged: false,
        }
    }
}

impl RunReport {
    /// Puts down a step, or an attempt at it.
    pub fn record(&mut self, record: StepRecord) {
        if record.converged {
            self.converged_steps += 1;
            self.iterations += record.iterations.len();
        }
        let last = self.steps.last().map_or(record.step, |last| last.step);
        if last != record.step && !self.keeps(last) {
            self.steps.truncate(self.steps.len() - self.steps.iter().rev().take_while(|own| own.step == last).count());
        }
        self.steps.push(record);
        while self.steps.len() > MOST_RECORDS && self.kept_every <= self.converged_steps {
            self.kept_every *= 2;
            let last = self.steps[self.steps.len() - 1].step;
            let mut steps = std::mem::take(&mut self.steps);
            steps.retain(|own| self.keeps(own.step) || own.step == last);
            self.steps = steps;
        }
    }

    /// Adds the numbers that processes report for the last step.
    pub fn add_numbers(&mut self, numbers: impl IntoIterator<Item = (&'static str, f64)>) {
        if let Some(last) = self.steps.last_mut() {
            last.interactions.extend(numbers.into_iter().map(|(name, value)| (name.to_owned(), value)));
        }
    }

    /// Adds the reactions by support to the balance of the last step, where it has one with sums of forces.
    pub(crate) fn add_supports(&mut self, of: impl FnOnce(&Balance) -> Vec<SupportReaction>) {
        let balance = self.steps.last_mut().and_then(|last| last.balance.as_mut());
        if let Some(balance) = balance.filter(|balance| !balance.unknowns.is_empty()) {
            balance.supports = of(balance);
        }
    }

    /// Puts down the extremes of the results.
    pub(crate) fn tell_extremes(&mut self, extremes: &Extremes) {
        let values =
            |all: &BTreeMap<String, Extreme>| all.iter().map(|(name, own)| (name.clone(), own.value)).collect();
        (self.largest, self.smallest) = (values(&extremes.largest), values(&extremes.smallest));
        let all = extremes.largest.iter().chain(&extremes.smallest);
        self.places =
            all.map(|(name, own)| (name.clone(), NodePlace { node: own.node, position: own.place })).collect();
    }

    /// Whether the records of a step stay.
    fn keeps(&self, step: usize) -> bool {
        step % self.kept_every == 1 % self.kept_every
    }

    /// Adds seconds to a phase.
    pub fn add_seconds(&mut self, phase: &str, seconds: f64) {
        *self.seconds.entry(phase.to_owned()).or_insert(0.0) += seconds;
    }

    /// Puts down why the run ended early.
    pub fn fail(&mut self, error: &Error) {
        self.exit_code = error.exit_code();
        match error {
            Error::Input(problems) => self.errors.extend(problems.iter().map(ToString::to_string)),
            other => self.errors.push(other.to_string()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_of_very_many_steps_are_thinned_evenly() {
        let mut report = RunReport::default();
        for step in 1..=1_000_000 {
            let attempts: &[bool] = if step % 1000 == 0 { &[false, true] } else { &[true] };
            for &converged in attempts {
                report.record(StepRecord { step, converged, ..StepRecord::default() });
            }
            assert!(report.steps.len() <= MOST_RECORDS && report.steps[report.steps.len() - 1].step == step);
        }
        assert_eq!((report.converged_steps, report.kept_every), (1_000_000, 128));
        let evenly = report.steps.iter().take_while(|own| own.step < 1_000_000).map(|own| own.step);
        assert!(evenly.eq((1..1_000_000).step_by(128)));
    }

    #[test]
    fn the_earlier_name_of_the_defaults_is_read() {
        let defaults_from_kratos = vec!["solver_settings.rotation_dofs = true".to_owned()];
        let report = RunReport { defaults_from_kratos, ..RunReport::default() };
        let text = serde_json::to_string(&report).expect("JSON");
        let earlier = text.replace("defaults_from_kratos", "laid_defaults");
        assert!(earlier != text);
        assert_eq!(serde_json::from_str::<RunReport>(&earlier).expect("a report"), report);
    }

    #[test]
    fn attempts_at_kept_steps_are_all_kept() {
        let mut report = RunReport::default();
        for step in 1..=3 {
            for converged in [false, false, true] {
                report.record(StepRecord { step, converged, ..StepRecord::default() });
            }
        }
        assert_eq!((report.steps.len(), report.converged_steps), (9, 3));
    }
}
