//! The iterations of one step: solve, move, let the interactions decide, judge.

use std::time::Instant;

use super::stabilization::{Stabilization, moves_freely};
use super::{ENERGY_OF_MOTION, NewtonRaphson, References};
use crate::assembly::System;
use crate::communication::Ranks;
use crate::diagnostics::{Error, Result};
use crate::entities::{Interaction, OuterLoop, SetChange};
use crate::model::ModelPart;
use crate::strategies::body_balance::Imbalance;
use crate::strategies::convergence_rate::{LONGEST_ADVANCE, advances, converges_linearly, oscillates};
use crate::strategies::criterion::ConvergenceCheck;
use crate::strategies::linear_solve::{Failed, Solved};
use crate::strategies::reactions::write_reactions;
use crate::strategies::records::{IterationRecord, Monitor};
use crate::strategies::strategy::{after_prediction, is_of_entities, relaxation, update_interactions};

/// Share of the increment that ends an oscillation between two states.
const HALF: f64 = 0.5;
/// How often an increment that turns elements inside out is halved.
const HALVINGS: usize = 4;

/// Phases of the interactions: the search for pairs, and the update of their states with pairs found late.
const SEARCH: &str = "interactions: search";
const STATES: &str = "interactions: states";

/// Iterations of a step with contact stabilisation, as a multiple of those of a step.
const STABILIZED: usize = 4;

/// Share of the tolerances that a linear solve may leave.
const LEFT: f64 = 0.01;

/// Data that the iterations of a step hand on to each other.
struct Step {
    /// Nodes that move before the mesh, see [`NewtonRaphson::moved_first`].
    moved_first: Option<Vec<u32>>,
    /// Unknowns at its start.
    begin: Vec<f64>,
    /// Increments that the next solve takes on through the tangent; zero where unknowns are free.
    prescribed: Vec<f64>,
    /// Out of balance in the present state, a number an unknown.
    residual: Vec<f64>,
    references: References,
    records: Vec<IterationRecord>,
    /// Regularisation of multipliers where constraints are redundant: the permitted amount, and the amount since a system was singular.
    relaxation: Option<f64>,
    relaxed: Option<f64>,
    /// Contact stabilisation, once a body has turned out to be free.
    stabilization: Option<Stabilization>,
    /// Why the last search in a converged state found more.
    widened: Option<String>,
    /// The body that was out of balance in the last state that met the criterion.
    imbalance: Option<Imbalance>,
    /// The last iteration it may take, and the last when it converges steadily.
    last: usize,
    most: usize,
}

impl Step {
    /// The relative residual that a linear solve may leave, small beside the tolerances; none in the first iteration, which may be the
    /// last.
    fn needed(&self) -> f64 {
        let missing = |check: &ConvergenceCheck| {
            (check.ratio_tolerance / check.ratio).max(check.absolute_tolerance / check.absolute).min(1.0)
        };
        let of_body = self.imbalance.as_ref().map_or(1.0, |own| own.tolerance / own.ratio);
        let last = self.records.last();
        last.map_or(0.0, |record| LEFT * record.checks.iter().map(missing).fold(of_body, f64::min))
    }
}

/// How an iteration ends.
enum IterationEnd {
    /// Another is needed.
    Continue,
    /// The state is accepted.
    Converged,
    /// No further iteration would help.
    Failed(String),
}

impl NewtonRaphson {
    /// The iterations of the step, and why they failed if they did.
    ///
    /// # Errors
    /// As [`SolutionStrategy::solve_step`](crate::strategies::SolutionStrategy::solve_step).
    pub(super) fn iterate(
        &mut self,
        part: &mut ModelPart,
        system: &mut System,
        monitor: &mut dyn Monitor,
    ) -> Result<(Vec<IterationRecord>, Option<String>)> {
        monitor.phase("search");
        self.begin_elastic(part);
        let mut step = self.begin_step(part, system)?;
        if let Some(what) = self.first_infinite(part, system, &step.residual) {
            return Ok((Vec::new(), Some(format!("the step cannot begin: {what}"))));
        }
        let mut iteration = 0;
        while iteration < step.last
            || (iteration < step.most && converges_linearly(&step.records, step.most - iteration))
            || (self.settings.continue_if_converging && iteration < LONGEST_ADVANCE && advances(&step.records))
        {
            iteration += 1;
            match self.iteration(iteration, &mut step, part, system, monitor)? {
                IterationEnd::Continue => {}
                IterationEnd::Failed(why) => return Ok((step.records, Some(why))),
                IterationEnd::Converged if self.end_elastic(part) => {
                    step.residual = self.residual(part, system)?;
                    let (last, most) = self.allowed();
                    (step.last, step.most) = (iteration + last, iteration + most);
                    let step = part.info.step;
                    monitor.note(&format!(
                        "step {step}: contact has settled with elastic elements, which may yield from here on"
                    ));
                }
                IterationEnd::Converged => {
                    self.keep_reactions(part, system, &step.residual);
                    step.imbalance = self.keep_balance(part, system, &step.residual, &step.references, None)?;
                    let Some(imbalance) = &step.imbalance else { return Ok((step.records, None)) };
                    if self.settings.linear {
                        self.warn_of_nonlinearity(imbalance);
                        step.last = self.settings.max_iteration;
                    }
                }
            }
        }
        let mut failure = self.explain(part, system, &step.records, &step.residual);
        if step.stabilization.is_some() {
            self.unrestrained = moves_freely(&step.records);
            if let Some(cause) = &self.singular_cause {
                self.singular = true;
                failure = format!("{cause}\n    with contact stabilization {failure}");
            }
        }
        let imbalance = step.imbalance.as_ref().map(Imbalance::fact);
        let failure = step.widened.iter().chain(&imbalance).fold(failure, |failure, why| format!("{failure}; {why}"));
        self.keep_reactions(part, system, &step.residual);
        Ok((step.records, Some(failure)))
    }

    fn begin_step(&mut self, part: &mut ModelPart, system: &mut System) -> Result<Step> {
        self.solver.forget();
        part.info.nl_iteration = 0;
        let start = Instant::now();
        for interaction in &mut system.interactions {
            interaction.begin_step(part)?;
        }
        self.phases.since(SEARCH, start);
        self.lay_out(part, system)?;
        self.stabilization_length = self.find_stabilization_length(part, system);
        if self.scheme.has_inertia() {
            self.redistribute_mass(part, system)?;
            if !part.info.values.contains_key(ENERGY_OF_MOTION) {
                self.measure_energy(part, system)?;
            }
        }
        if let Some(past) = self.scheme.past_inertia(part, &system.dofs) {
            let forces = self.assembler.inertia_forces(part, system, &past)?;
            self.scheme.keep(forces);
        }
        let begin = self.assembler.values(part, system);
        let moved_first = self.moved_first(part, system);
        let prescribed = self.start(part, system, moved_first.as_deref())?;
        let start = Instant::now();
        after_prediction(part, &mut system.interactions)?;
        self.phases.since(STATES, start);
        let mut residual = self.residual(part, system);
        if residual.is_err() && self.scheme.has_inertia() {
            self.stay(part, system);
            after_prediction(part, &mut system.interactions)?;
            residual = self.residual(part, system);
        }
        Ok(Step {
            moved_first,
            begin,
            prescribed,
            residual: residual?,
            references: References::default(),
            records: Vec::new(),
            relaxation: relaxation(&system.interactions),
            relaxed: None,
            stabilization: if self.stabilizes { self.stabilization() } else { None },
            widened: None,
            imbalance: None,
            last: self.allowed().0,
            most: self.allowed().1,
        })
    }

    fn iteration(
        &mut self,
        iteration: usize,
        step: &mut Step,
        part: &mut ModelPart,
        system: &mut System,
        monitor: &mut dyn Monitor,
    ) -> Result<IterationEnd> {
        if !self.settings.linear {
            part.info.nl_iteration = iteration;
        }
        let solved = self
            .solve_tangent(iteration, step, part, system, monitor)
            .and_then(|solved| self.with_follower(solved, &step.prescribed, part, system));
        let solved = match solved {
            Ok(solved) => solved,
            Err(failed) => return self.give_up(failed, iteration, &step.residual, part, system),
        };
        if let Some(why) = &solved.fallback {
            monitor.note(&format!("linear solver: {why}"));
        }
        let condition =
            if part.info.solver.condition_number { self.condition_number(part, system, monitor) } else { None };
        monitor.phase("states and residual");
        // Prescribed increments must be applied in full.
        let is_still = !has_motion(&part.ranks, &step.prescribed);
        let mut increment = self.take(&solved, step, part, system)?;
        if let Some(what) = self.first_infinite(part, system, &step.residual) {
            return Ok(IterationEnd::Failed(format!("diverged in iteration {iteration}: {what}")));
        }
        // Ahead of the mesh, prescribed values strain one layer of elements; where that is too much, the first iterate only serves the
        // interactions that keep it.
        let restart =
            step.moved_first.is_some() && iteration == 1 && self.overshoots(part, system, &step.references.start[0])?;
        let mut change =
            self.decide(iteration, restart, step, part, system, Some(&mut increment).filter(|_| is_still))?;
        if let Some(stabilization) = &step.stabilization {
            let joint = self.decide_stabilized(stabilization, part, system)?;
            if joint.count() > 0 {
                step.residual = self.residual(part, system)?;
                change.extend(joint);
            }
        }
        if let Some(why) = self.follow(part, system, &mut step.residual)? {
            return Ok(IterationEnd::Failed(why));
        }
        let balanced = self.assembler.equations().balanced(&step.residual);
        if iteration == 1 {
            self.refer_to_first(system, &balanced, &mut step.references);
        }
        if change.count() > 0 {
            step.references.switched = Some(balanced.to_vec());
        }
        if !system.interactions.is_empty() {
            let start = Instant::now();
            let balance = self.assembler.equations().reduce(&step.residual);
            observe(&mut system.interactions, part, iteration, &balance);
            self.phases.since(STATES, start);
        }
        let start = Instant::now();
        let verdict = self.judge(part, system, iteration, &self.with_pending(step), &step.references, &increment);
        self.phases.since("judge", start);
        agree(&part.ranks, iteration, &change, verdict.converged)?;
        let record = IterationRecord {
            condition_number: condition,
            ..IterationRecord::new(iteration, verdict.checks, &change, &solved)
        };
        monitor.iteration(&record);
        step.records.push(record);
        if let Some(what) = self.first_infinite(part, system, &step.residual) {
            return Ok(IterationEnd::Failed(format!("diverged in iteration {iteration}: {what}")));
        }
        if restart {
            step.prescribed = self.begin_again(part, system, &step.begin)?;
            step.residual = self.residual(part, system)?;
            return Ok(IterationEnd::Continue);
        }
        if verdict.converged
            && change.count() == 0
            && !system.interactions.is_empty()
            && let Some(why) = self.lost_body(part, system, &step.begin)
        {
            return Ok(IterationEnd::Failed(why));
        }
        match (self.settings.linear, verdict.converged && change.count() == 0) {
            (true, _) => Ok(IterationEnd::Converged),
            (false, false) => Ok(IterationEnd::Continue),
            // One iteration without stabilisation shows whether contact restrains all bodies now.
            (false, true) if step.stabilization.take().is_some() => {
                step.last = step.last.max(iteration + 1);
                Ok(IterationEnd::Continue)
            }
            (false, true) => self.judge_converged(iteration, step, part, system, monitor),
        }
    }

    /// Solves with the tangent of the present state, with multipliers relaxed once that has turned out to be needed.
    fn solve_tangent(
        &mut self,
        iteration: usize,
        step: &mut Step,
        part: &mut ModelPart,
        system: &mut System,
        monitor: &mut dyn Monitor,
    ) -> Result<Solved, Failed> {
        let constraints = constraints_version(&system.interactions);
        let mut solved = self.solve_once(iteration, step, part, system, monitor);
        while matches!(solved, Err(Failed::Singular(..))) && restrain_free_bodies(&mut system.interactions, part) {
            if constraints != constraints_version(&system.interactions) {
                self.lay_out(part, system)?;
                step.prescribed = self.followed(part, system, &step.prescribed);
            }
            solved = self.solve_again(iteration, step, part, system, monitor);
        }
        if step.stabilization.is_none()
            && self.stabilization_length.is_some()
            && let Some(cause) = self.unrestrained(&solved, part, system)
        {
            // Later iterates have followed a tangent that let a body go: such a step begins anew.
            step.stabilization = self.stabilization().filter(|_| iteration == 1);
            self.singular_cause = Some(cause.clone());
            if step.stabilization.is_some() {
                let stabilized = self.solve_again(iteration, step, part, system, monitor);
                if stabilized.is_ok() {
                    self.stabilizes = true;
                    let step = part.info.step;
                    monitor.note(&format!(
                        "step {step}: contact stabilization, since contact does not restrain a body yet"
                    ));
                    return stabilized;
                }
                // Not for want of restraint: the system as it is.
                step.stabilization = None;
                solved = self.solve_again(iteration, step, part, system, monitor);
            } else if solved.is_ok() {
                return Err(Failed::Singular(cause, Vec::new()));
            }
        }
        let (Err(Failed::Singular(why, _) | Failed::Inaccurate(why)), None, Some(amount)) =
            (&solved, step.relaxed, step.relaxation)
        else {
            return solved;
        };
        step.relaxed = Some(amount);
        self.assembler.relax_multipliers(&system.dofs, amount);
        let rhs = self.assembler.equations().reduce(&step.residual);
        let relaxed = self.solve(part, system, &rhs)?;
        self.warn_of_redundancy(why);
        Ok(relaxed)
    }

    /// Solves anew in the present state, which the interactions have changed, or with another tangent.
    fn solve_again(
        &mut self,
        iteration: usize,
        step: &mut Step,
        part: &mut ModelPart,
        system: &mut System,
        monitor: &mut dyn Monitor,
    ) -> Result<Solved, Failed> {
        step.residual = self.residual(part, system)?;
        if iteration == 1 {
            step.references.start.clear();
        }
        self.solve_once(iteration, step, part, system, monitor)
    }

    fn solve_once(
        &mut self,
        iteration: usize,
        step: &mut Step,
        part: &mut ModelPart,
        system: &mut System,
        monitor: &mut dyn Monitor,
    ) -> Result<Solved, Failed> {
        monitor.phase("assemble");
        let inertia = self.scheme.inertia(part, &system.dofs);
        self.assembler.tangents(part, system, inertia.as_ref())?;
        if let Some(amount) = step.relaxed {
            self.assembler.relax_multipliers(&system.dofs, amount);
        }
        if has_motion(&part.ranks, &step.prescribed) {
            self.assembler.subtract_product(&step.prescribed, &mut step.residual);
        }
        if iteration == 1 {
            self.refer_to_start(part, system, &step.residual, &mut step.references)?;
        }
        if let Some(stabilization) = &mut step.stabilization {
            self.stabilize(stabilization, part, system, &step.residual, &step.records)?;
        }
        let rhs = self.assembler.equations().reduce(&step.residual);
        if iteration == 1 {
            observe(&mut system.interactions, part, 0, &rhs);
        }
        self.solver.set_forcing_term(step.needed());
        monitor.phase("solve");
        self.solve(part, system, &rhs)
    }

    /// Outcome of the step after a solve without a result.
    ///
    /// # Errors
    /// One that no shorter step would mend.
    fn give_up(
        &mut self,
        failed: Failed,
        iteration: usize,
        residual: &[f64],
        part: &ModelPart,
        system: &System,
    ) -> Result<IterationEnd> {
        match failed {
            // Interactions may have let a body go that a shorter step holds.
            Failed::Singular(why, _) if !system.interactions.is_empty() => {
                self.singular = true;
                Ok(IterationEnd::Failed(why))
            }
            Failed::Inaccurate(why) if !system.interactions.is_empty() => {
                self.singular = true;
                let worst = self.largest_residual(part, system, &self.assembler.equations().balanced(residual));
                Ok(IterationEnd::Failed(why + &worst.unwrap_or_default()))
            }
            // A load or a material at its limit leaves no stiffness; a shorter step ends before it.
            Failed::Singular(why, _) | Failed::Inaccurate(why)
                if self.assembler.has_variable_elements() && (iteration > 1 || part.info.step > 1) =>
            {
                let first = why.lines().next().unwrap_or_default();
                let limit = "at a limit load prescribe displacements, or use \"arc_length\"";
                let worst = self.largest_residual(part, system, &self.assembler.equations().balanced(residual));
                Ok(IterationEnd::Failed(format!(
                    "iteration {iteration}: {first}{}; {limit}",
                    worst.unwrap_or_default()
                )))
            }
            failed => Err(failed.into()),
        }
    }

    /// Applies the increments of solved and prescribed unknowns; returns the increment of all unknowns.
    fn take(&mut self, solved: &Solved, step: &mut Step, part: &mut ModelPart, system: &System) -> Result<Vec<f64>> {
        let mut increment = self.assembler.equations().expand(&solved.increment);
        let is_still = !has_motion(&part.ranks, &step.prescribed);
        let after_failure = self.settings.line_search_after_failure.filter(|_| self.searches);
        let searched = self.settings.line_search.or(after_failure).filter(|_| is_still);
        increment.iter_mut().zip(&step.prescribed).for_each(|(sum, d)| *sum += d);
        step.prescribed.fill(0.0);
        if is_still && searched.is_none() && oscillates(&step.records) {
            increment.iter_mut().for_each(|d| *d *= HALF);
        }
        match searched {
            Some(search) => self.search(&search, part, system, &step.residual, &mut increment)?,
            None => self.move_by(part, system, &increment),
        }
        Ok(increment)
    }

    /// Lets the interactions follow the motion, and takes the residual of the state they decide on; `restart` where they only keep the
    /// values that the solution takes from the first iterate. Where elements cannot be computed there, less is taken of `increment`, if
    /// it is given.
    fn decide(
        &mut self,
        iteration: usize,
        restart: bool,
        step: &mut Step,
        part: &mut ModelPart,
        system: &mut System,
        increment: Option<&mut Vec<f64>>,
    ) -> Result<SetChange> {
        if system.interactions.iter_mut().filter_map(|i| i.active_set()).any(|set| set.needs_reactions()) {
            let residual = self.residual(part, system)?;
            write_reactions(part, &system.dofs, &residual, None);
        }
        let (constraints, graph) = (constraints_version(&system.interactions), graph_version(&system.interactions));
        let start = Instant::now();
        let change = if restart {
            system.interactions.iter_mut().filter_map(|i| i.first_iterate()).for_each(|first| first.keep(part));
            SetChange::default()
        } else {
            update_interactions(part, &mut system.interactions, iteration)?
        };
        self.phases.since(STATES, start);
        if constraints != constraints_version(&system.interactions) {
            self.lay_out(part, system)?;
            step.prescribed = self.constraint_increment(part, system);
        } else if graph != graph_version(&system.interactions) {
            self.lay_out(part, system)?;
        }
        step.residual = self.residual(part, system).or_else(|why| match increment {
            Some(increment) if is_of_entities(&why) => self.step_back(part, system, increment, why),
            _ => Err(why),
        })?;
        Ok(change)
    }

    /// Goes back by half of the increment, and by half of the remainder, until elements can be computed; returns the residual there.
    ///
    /// # Errors
    /// `why` they could not be computed, where the least share does not help.
    fn step_back(
        &mut self,
        part: &mut ModelPart,
        system: &System,
        increment: &mut [f64],
        mut why: Error,
    ) -> Result<Vec<f64>> {
        for _ in 0..HALVINGS {
            let back: Vec<f64> = increment.iter().map(|d| (HALF - 1.0) * d).collect();
            self.move_by(part, system, &back);
            increment.iter_mut().for_each(|d| *d *= HALF);
            match self.residual(part, system) {
                Err(error) if is_of_entities(&error) => why = error,
                found => return found,
            }
        }
        Err(why)
    }

    /// The residual as the equations see it, with the force of motions that changed constraints still ask for. Collective.
    fn with_pending(&self, step: &Step) -> Vec<f64> {
        let mut residual = step.residual.clone();
        if has_motion(self.assembler.ranks(), &step.prescribed) {
            self.assembler.subtract_product(&step.prescribed, &mut residual);
        }
        self.assembler.equations().balanced(&residual).into_owned()
    }

    /// Asks the interactions whether a converged state may be accepted; where it may not, the count of iterations begins anew.
    fn judge_converged(
        &mut self,
        iteration: usize,
        step: &mut Step,
        part: &mut ModelPart,
        system: &mut System,
        monitor: &mut dyn Monitor,
    ) -> Result<IterationEnd> {
        let mut accepted = true;
        let start = Instant::now();
        for at in 0..system.interactions.len() {
            let Some(set) = system.interactions[at].active_set() else { continue };
            set.look_at(part, &system.elements);
            let mut outer = set.after_convergence(part)?;
            if outer == OuterLoop::DecideTogether {
                let said;
                (outer, said) = self.decide_together(at, step.stabilization.as_ref(), part, system)?;
                said.iter().for_each(|said| monitor.note(&format!("step {}: {said}", part.info.step)));
            }
            match outer {
                OuterLoop::Done | OuterLoop::DecideTogether => {}
                OuterLoop::Continue => accepted = false,
                OuterLoop::PairsAdded(why) => {
                    monitor.note(&format!("step {}: {why}; the iteration continues with them", part.info.step));
                    step.widened = Some(why);
                    accepted = false;
                }
                OuterLoop::StepTooLarge(why) => self.coarse = Some(why),
                OuterLoop::Failed(why) => return Ok(IterationEnd::Failed(why)),
            }
        }
        self.phases.since(SEARCH, start);
        if accepted {
            return Ok(IterationEnd::Converged);
        }
        self.lay_out(part, system)?;
        let (last, most) = self.allowed();
        (step.last, step.most) = (iteration + last, iteration + most);
        if step.stabilization.is_some() {
            step.last = step.last.min(STABILIZED * last);
            step.most = step.last;
        }
        step.residual = self.residual(part, system)?;
        Ok(IterationEnd::Continue)
    }

    /// The equations and sparsity patterns of the active interactions.
    fn lay_out(&mut self, part: &ModelPart, system: &System) -> Result<()> {
        let start = Instant::now();
        let result = self.assembler.begin_step(part, system);
        self.phases.since("assemble: equations", start);
        result
    }

    /// Iterations of a step, and of one that converges steadily.
    fn allowed(&self) -> (usize, usize) {
        let last = if self.settings.linear { 1 } else { self.settings.max_iteration };
        (last, if self.settings.continue_if_converging && !self.settings.linear { 2 * last } else { last })
    }

    pub(super) fn residual(&mut self, part: &ModelPart, system: &System) -> Result<Vec<f64>> {
        let inertia = self.scheme.inertia(part, &system.dofs);
        self.assembler.residual(part, system, inertia.as_ref())
    }

    /// Writes reactions, if the settings ask for it.
    pub(in crate::strategies) fn keep_reactions(&self, part: &mut ModelPart, system: &System, residual: &[f64]) {
        if self.settings.compute_reactions {
            let handed_on = self.settings.reactions_of_constraints.then(|| self.assembler.equations());
            write_reactions(part, &system.dofs, residual, handed_on);
        }
    }
}

/// Whether an unknown of any rank moves by prescription; collective.
fn has_motion(ranks: &Ranks, prescribed: &[f64]) -> bool {
    ranks.any(prescribed.iter().any(|d| *d != 0.0))
}

/// # Errors
/// Ranks that hold different states and would go different ways.
fn agree(ranks: &Ranks, iteration: usize, change: &SetChange, converged: bool) -> Result<()> {
    let decided = (change.count() as u64) << 1 | u64::from(converged);
    if ranks.is_same(decided) {
        return Ok(());
    }
    let fact = format!("iteration {iteration}: the ranks have come to different decisions");
    Err(Error::System(format!("{fact}\n    run them on machines of one kind, or on fewer ranks")))
}

/// Shows the balance of an iterate to those who look at it.
fn observe(interactions: &mut [Box<dyn Interaction>], part: &ModelPart, iteration: usize, residual: &[f64]) {
    let observers = interactions.iter_mut().filter_map(|interaction| interaction.observer());
    observers.for_each(|observer| observer.observe(part, iteration, residual));
}

/// Whether any interaction activates contact of bodies that are free to move.
fn restrain_free_bodies(interactions: &mut [Box<dyn Interaction>], part: &mut ModelPart) -> bool {
    let mut any = false;
    for interaction in interactions {
        any |= interaction.active_set().is_some_and(|set| set.restrain_free_bodies(part));
    }
    any
}

fn graph_version(interactions: &[Box<dyn Interaction>]) -> u64 {
    let couplings = interactions.iter().filter_map(|interaction| interaction.coupling());
    couplings.fold(0, |sum, coupling| sum.wrapping_mul(31).wrapping_add(coupling.graph_version()))
}

fn constraints_version(interactions: &[Box<dyn Interaction>]) -> u64 {
    interactions.iter().fold(0, |sum, interaction| sum.wrapping_mul(31).wrapping_add(interaction.constraints_version()))
}
