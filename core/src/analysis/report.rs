//! The report of a run: what was solved, how it went, how long it took.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::diagnostics::Error;
use crate::strategies::StepRecord;

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

/// What a run leaves behind, as written by `--report`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunReport {
    /// Version of the program.
    pub version: String,
    /// Name of the problem.
    pub problem: String,
    /// Program whose defaults hold where the deck names nothing; `None` for our own.
    pub like: Option<String>,
    /// The settings that this gave the deck, as `object.key = value`.
    pub laid_defaults: Vec<String>,
    /// Stages run.
    pub stages: Vec<String>,
    /// Sizes of the last stage.
    pub sizes: Sizes,
    /// Accepted steps and failed attempts, in order.
    pub steps: Vec<StepRecord>,
    /// Exit code of the program: 0 done and converged, 2 bad input, 3 not converged, 4 system or solver failure, 5 stopped and
    /// saved.
    pub exit_code: u8,
    /// Why the run ended early, in words.
    pub errors: Vec<String>,
    /// Notes, in words.
    pub notes: Vec<String>,
    /// Warnings, in words.
    pub warnings: Vec<String>,
    /// Which engine serves the deck's linear solver.
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
            laid_defaults: Vec::new(),
            stages: Vec::new(),
            sizes: Sizes::default(),
            steps: Vec::new(),
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
            converged: false,
        }
    }
}

impl RunReport {
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
