//! Staggered coupling of heat and a structure within a step, until the temperatures converge: `coupling_settings`, "staggered".
//!
//! A sweep solves for heat from the start of the step, on the mesh and with the contact that the structure has just found: T̃ =
//! H(S(T)), where T are the temperatures that the structure was solved with. The step ends where T̃ differs from T by no more than the
//! tolerance times the spread of temperatures (the largest less the smallest, at both ends of the step); it is then T̃ that counts.
//! Else the structure continues with the temperatures of Anderson's acceleration over the last sweeps: with the residuals r = T̃ - T,
//! and Δ their differences and those of T̃,
//!
//! T' = T̃ - Σ γ_j ΔT̃_j, γ such that |r - Σ γ_j Δr_j| is least
//!
//! (Anderson, 1965; Walker and Ni, 2011), which converges fast, also where plain repetition oscillates.

use std::sync::{Arc, Mutex, PoisonError};

use nalgebra::{DMatrix, DVector};
use zelus_core::diagnostics::Result;
use zelus_core::entities::{ActiveSet, EntityBlock, Interaction, OuterLoop, SetChange};
use zelus_core::model::ModelPart;
use zelus_core::strategies::Silent;

use crate::columns::Columns;
use crate::heat::Heat;

/// Sweeps that are looked back on.
const MEMORY: usize = 5;
/// Share of the largest eigenvalue below which differences of sweeps count as dependent.
const DEPENDENT: f64 = 1e-12;

/// When sweeps end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StaggeredSettings {
    /// Largest change of a temperature, over their spread.
    pub(crate) tolerance: f64,
    /// Sweeps that may take.
    pub(crate) most: usize,
}

/// Looks again at heat whenever the structure has converged.
pub(crate) struct StaggeredCoupling {
    heat: Arc<Mutex<Heat>>,
    goal: StaggeredSettings,
    /// Temperatures at the start of the step, prescribed ones as they are at its end.
    start: Vec<f64>,
    /// Temperatures with which the structure was last solved.
    taken: Vec<f64>,
    /// T̃ and T̃ - T of the last sweeps, the latest at the end.
    past: Vec<[Vec<f64>; 2]>,
    /// Sweeps since both last agreed: the structure may go on for reasons of its own.
    since: usize,
}

impl StaggeredCoupling {
    /// For a step whose heat has been solved for once; `start` are the temperatures from which it was.
    pub(crate) fn new(heat: Arc<Mutex<Heat>>, goal: StaggeredSettings, part: &ModelPart, start: Vec<f64>) -> Self {
        let taken = temperatures(part, 0).to_vec();
        Self { heat, goal, start, taken, past: Vec::new(), since: 0 }
    }

    /// Solves for heat in the present state of the structure, which must go on where temperatures change by it. Collective.
    ///
    /// # Errors
    /// As [`SolutionStrategy::solve_step`](zelus_core::strategies::SolutionStrategy::solve_step).
    pub(crate) fn solve_heat_again(&mut self, part: &mut ModelPart) -> Result<OuterLoop> {
        self.since += 1;
        let unknown = Columns::of(part).unknown.column;
        part.nodes.history.write_level(unknown, 0, &self.start);
        let mut heat = self.heat.lock().unwrap_or_else(PoisonError::into_inner);
        heat.sweeps += 1;
        let record = heat.solve_step(part, &mut Silent)?;
        if !record.converged {
            return Ok(OuterLoop::Failed(record.failure.map_or("heat".to_owned(), |why| format!("heat: {why}"))));
        }
        heat.last = Some(record);
        drop(heat);
        let change: Vec<f64> = temperatures(part, 0).iter().zip(&self.taken).map(|(new, old)| new - old).collect();
        let (largest, spread) = sizes(part, &change);
        if largest <= self.goal.tolerance * spread {
            self.since = 0;
            self.past.clear();
            self.taken = temperatures(part, 0).to_vec();
            return Ok(OuterLoop::Done);
        }
        if self.since >= self.goal.most {
            return Ok(OuterLoop::Failed(format!(
                "heat and structure do not agree after {} sweeps: temperatures still change by {largest:.1e} of {spread:.3e}; \
                 \"coupling_settings\": {{\"strategy\": \"monolithic\"}} finds both in one iteration, if there is a steady state; \
                 \"sequential\" solves for each once a step",
                self.since
            )));
        }
        self.past.push([temperatures(part, 0).to_vec(), change]);
        if self.past.len() > MEMORY + 1 {
            self.past.remove(0);
        }
        self.taken = accelerated(part, &self.past);
        part.nodes.history.write_level(unknown, 0, &self.taken);
        Ok(OuterLoop::Continue)
    }
}

fn temperatures(part: &ModelPart, level: usize) -> &[f64] {
    part.nodes.history.level(Columns::of(part).unknown.column, level)
}

/// The largest change, and the spread of temperatures at both ends of the step. Collective.
pub(crate) fn sizes(part: &ModelPart, change: &[f64]) -> (f64, f64) {
    let all = || temperatures(part, 0).iter().chain(temperatures(part, 1)).copied();
    let own = [
        change.iter().fold(0.0, |most: f64, d| most.max(d.abs())),
        all().fold(f64::NEG_INFINITY, f64::max),
        -all().fold(f64::INFINITY, f64::min),
    ];
    let over_ranks = part.ranks.gather_numbers(&own);
    let largest = |at: usize| over_ranks.iter().map(|of_rank| of_rank[at]).fold(f64::NEG_INFINITY, f64::max);
    (largest(0), largest(1) + largest(2))
}

/// T' from T̃ and r of the last sweeps, the latest at the end. Collective.
fn accelerated(part: &ModelPart, past: &[[Vec<f64>; 2]]) -> Vec<f64> {
    let Some(([found, residual], earlier)) = past.split_last() else { return Vec::new() };
    let difference = |of: usize, j: usize, node: usize| past[j + 1][of][node] - past[j][of][node];
    let sum = |term: &dyn Fn(usize) -> f64| {
        let own: f64 = (0..found.len()).filter(|&node| part.owns_node(node)).map(term).sum();
        if part.share.is_some() { part.ranks.total(own) } else { own }
    };
    let count = earlier.len();
    if count == 0 {
        return found.clone();
    }
    let gram = DMatrix::from_fn(count, count, |i, j| sum(&|node| difference(1, i, node) * difference(1, j, node)));
    let along = DVector::from_fn(count, |i, _| sum(&|node| difference(1, i, node) * residual[node]));
    let svd = gram.svd(true, true);
    let least = DEPENDENT * svd.singular_values.iter().fold(0.0, |most: f64, value| most.max(*value));
    let factors = svd.solve(&along, least.max(f64::MIN_POSITIVE)).unwrap_or_else(|_| DVector::zeros(count));
    let moved = |node: usize| (0..count).map(|j| factors[j] * difference(0, j, node)).sum::<f64>();
    (0..found.len()).map(|node| found[node] - moved(node)).collect()
}

impl Interaction for StaggeredCoupling {
    fn name(&self) -> &str {
        "staggered heat and structure"
    }

    fn active_set(&mut self) -> Option<&mut dyn ActiveSet> {
        Some(self)
    }
}

impl ActiveSet for StaggeredCoupling {
    fn after_update(&mut self, _part: &mut ModelPart, _iteration: usize) -> Result<SetChange> {
        Ok(SetChange::default())
    }

    fn look_at(&mut self, part: &mut ModelPart, elements: &[Box<dyn EntityBlock>]) {
        self.heat.lock().unwrap_or_else(PoisonError::into_inner).plastic.take(part, elements);
    }

    fn after_convergence(&mut self, part: &mut ModelPart) -> Result<OuterLoop> {
        self.solve_heat_again(part)
    }
}
