//! Records of a step for the log and the report of the run.

use super::balance::Balance;
use super::criterion::ConvergenceCheck;
use super::linear_solve::Solved;
use super::omitted_fields::omitted_from_json;
use crate::entities::SetChange;

/// Relative difference of measures that a step of another length leaves where it only scales the problem, and the measure below
/// which they are round-off.
const SAME: f64 = 1e-6;
const NONE: f64 = 1e-9;

/// Most nodes that a record names.
const NAMED_NODES: usize = 12;

/// One Newton iteration.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(remote = "Self")]
pub struct IterationRecord {
    /// From 1.
    pub iteration: usize,
    /// Measurements of the criteria.
    pub checks: Vec<ConvergenceCheck>,
    /// Nodes that became active or inactive.
    pub active_set_changes: usize,
    /// Nodes that changed between stick and slip.
    pub stick_slip_changes: usize,
    /// Ids of (some of) the nodes that changed.
    pub changed_nodes: Vec<usize>,
    /// Relative residual of the linear solve.
    pub linear_residual: f64,
    /// Krylov iterations of the linear solve, or its steps of refinement.
    pub linear_iterations: usize,
    /// Engine of the linear solve.
    pub engine: String,
    /// Condition number of the system, where it is asked for.
    #[serde(default)]
    pub condition_number: Option<f64>,
}

omitted_from_json!(IterationRecord, "condition_number");

impl IterationRecord {
    /// Record of an iteration with this solve: the measurements of the criteria, and the changes of the interactions.
    pub(super) fn new(iteration: usize, checks: Vec<ConvergenceCheck>, change: &SetChange, solved: &Solved) -> Self {
        let changed = change.activated.iter().chain(&change.deactivated).chain(&change.stick_slip);
        Self {
            iteration,
            checks,
            active_set_changes: change.activated.len() + change.deactivated.len(),
            stick_slip_changes: change.stick_slip.len(),
            changed_nodes: changed.copied().take(NAMED_NODES).collect(),
            linear_residual: solved.relative_residual,
            linear_iterations: solved.iterations,
            engine: solved.engine.clone(),
            condition_number: None,
        }
    }
}

/// One step, or one attempt at it.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(remote = "Self")]
pub struct StepRecord {
    /// Number of the step.
    pub step: usize,
    /// Time at its end.
    pub time: f64,
    /// Its length.
    pub delta_time: f64,
    /// Whether it converged.
    pub converged: bool,
    /// Its iterations; their number is the number of linear solves.
    pub iterations: Vec<IterationRecord>,
    /// Why it did not converge.
    pub failure: Option<String>,
    /// Whether it failed because the system of equations was singular.
    #[serde(skip)]
    pub singular: bool,
    /// Whether a body moved on freely with contact stabilisation, so that a shorter step would not help.
    #[serde(skip)]
    pub unrestrained: bool,
    /// Why a shorter step would be better, though it converged.
    #[serde(skip)]
    pub coarse: Option<String>,
    /// Numbers of interactions and processes by name, e.g. active nodes.
    pub interactions: Vec<(String, f64)>,
    /// Balance of loads, reactions and remainder, where the step converged by iteration.
    #[serde(default)]
    pub balance: Option<Balance>,
}

omitted_from_json!(StepRecord, "balance");

impl StepRecord {
    /// Whether it failed within its iteration, and not because a state that had converged was refused.
    pub fn failed_to_converge(&self) -> bool {
        let has_settled = |last: &IterationRecord| {
            last.active_set_changes + last.stick_slip_changes == 0 && last.checks.iter().all(|check| check.converged)
        };
        !self.converged && !self.singular && !self.iterations.last().is_some_and(has_settled)
    }

    /// Whether its residual ended larger than it began, so that the iteration has left the neighbourhood of a solution.
    pub fn has_diverged(&self) -> bool {
        let grown = |check: &ConvergenceCheck| check.ratio > 1.0;
        self.failed_to_converge() && self.iterations.last().is_some_and(|last| last.checks.iter().any(grown))
    }

    /// Whether an attempt failed just as this one did: the same measures and changes of state in every iteration.
    ///
    /// Where nothing but the size of the load tells two steps apart, as without a gap, friction or curvature, a shorter one
    /// is the same problem.
    pub fn fails_like(&self, other: &Self) -> bool {
        let alike = |a: &ConvergenceCheck, b: &ConvergenceCheck| {
            (a.ratio - b.ratio).abs() <= SAME * a.ratio.max(b.ratio) + NONE
        };
        let same = |(a, b): (&IterationRecord, &IterationRecord)| {
            a.active_set_changes == b.active_set_changes
                && a.stick_slip_changes == b.stick_slip_changes
                && a.changed_nodes == b.changed_nodes
                && a.checks.iter().zip(&b.checks).all(|(a, b)| alike(a, b))
        };
        self.singular == other.singular
            && self.iterations.len() == other.iterations.len()
            && self.iterations.iter().zip(&other.iterations).all(same)
            && (!self.iterations.is_empty() || self.singular)
    }
}

/// Plan of a stage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plan {
    /// Its number, from 1.
    pub stage: usize,
    /// Stages in all.
    pub stages: usize,
    /// The time it begins at.
    pub start: f64,
    /// The time it ends at.
    pub end: f64,
    /// Steps, where none is cut and the deck says how long they are.
    pub steps: Option<usize>,
}

/// Watches a run; the program prints, tests stay silent.
pub trait Monitor: Send {
    /// A stage is ready to run.
    fn begin_stage(&mut self, _plan: &Plan) {}
    /// Phase that begins, e.g. `assemble`.
    fn phase(&mut self, _phase: &'static str) {}
    /// A step begins.
    fn begin_step(&mut self, _step: usize, _time: f64, _delta_time: f64) {}
    /// An iteration is done.
    fn iteration(&mut self, _record: &IterationRecord) {}
    /// A step (or an attempt at it) is over.
    fn end_step(&mut self, _record: &StepRecord) {}
    /// Something worth a line.
    fn note(&mut self, _text: &str) {}
    /// Something the user should know of.
    fn warn(&mut self, _warning: &crate::diagnostics::Diagnostic) {}
}

/// Watches and says nothing.
#[derive(Debug, Default)]
pub struct Silent;

impl Monitor for Silent {}
