//! Newton's iteration of one step, semi-smooth where an active set changes.

mod elastic_start;
mod followers;
mod iteration;
mod joint_decision;
mod lost_body;
mod references;
mod stabilization;
mod start;

use std::cell::LazyCell;
use std::time::Instant;

use serde::{Deserialize, Serialize};
#[cfg(feature = "petsc")]
use zelus_linear_algebra::Multipliers;
use zelus_linear_algebra::{LinearSolver, SolveReport};
use zelus_linear_algebra::{State, StateMapper, stored_as_bytes};

pub(super) use references::References;
pub(crate) use stabilization::ONLY_CONTACT_RESTRAINS;

use super::balance::Balance;
use super::body_balance::{BodyBalance, BodyDofs, Imbalance};
use super::condensing;
use super::criterion::{ConvergenceCriterion, Measures, Verdict};
use super::dof_name::DofName;
use super::energy_balance::EnergyBalance;
use super::line_search::LineSearch;
use super::linear_solve::{self, Failed, Solved};
use super::location::location;
use super::phases::Phases;
use super::records::{IterationRecord, Monitor, StepRecord};
use super::root_gather::RootGather;
use super::scheme::Scheme;
use super::strategy::{Linearized, SolutionStrategy, accept, is_of_entities, recorded};
use crate::assembly::{Assembler, AssemblerState, System, impose_constraints};
use crate::diagnostics::unfit;
use crate::diagnostics::{Diagnostic, Place, Result};
use crate::model::{ModelPart, NumberedBodies};

/// Nodes that a message of a failure describes.
const DESCRIBED: usize = 4;

/// Largest share of the forces on a body that may be out of balance, for criteria that measure no residual.
const BALANCE_TOLERANCE: f64 = 1e-4;

/// Value of the step data: the largest energy that bodies in motion have had.
pub const ENERGY_OF_MOTION: &str = "ENERGY_OF_MOTION";

/// How a step is iterated.
#[derive(Debug, Clone, PartialEq)]
pub struct NewtonSettings {
    /// Linear solves before the step counts as not converged.
    pub max_iteration: usize,
    /// Whether a step that converges steadily may take as many again.
    pub continue_if_converging: bool,
    /// One linear solve and no check (`analysis_type` "linear").
    pub linear: bool,
    /// Whether reactions are computed.
    pub compute_reactions: bool,
    /// Whether reactions of supports include the forces that constraints hand on to them.
    pub reactions_of_constraints: bool,
    /// Whether nodes follow the unknown that moves the mesh.
    pub move_mesh: bool,
    /// The rule for bodies that are out of balance where the criterion is met.
    pub body_balance: BodyBalance,
    /// How much of an increment is taken; all of it when `None`.
    pub line_search: Option<LineSearch>,
    /// The same for steps that have failed, where they may be tried again so.
    pub line_search_after_failure: Option<LineSearch>,
    /// Whether bodies that contact does not restrain yet are stabilised.
    pub contact_stabilization: bool,
    /// Whether steps that have failed may begin with elastic elements.
    pub elastic_start_after_failure: bool,
}

/// Newton's iteration with its scheme, criterion, linear solver and system.
pub struct NewtonRaphson {
    pub(super) settings: NewtonSettings,
    scheme: Box<dyn Scheme>,
    pub(super) criterion: Box<dyn ConvergenceCriterion>,
    pub(super) solver: Box<dyn LinearSolver>,
    pub(super) assembler: Assembler,
    /// Whether the last step did not converge.
    failed: bool,
    /// Whether it searches along increments, since the step has failed without that.
    searches: bool,
    /// Length of contact stabilisation in the last step, where it may be stabilised.
    stabilization_length: Option<f64>,
    /// Whether steps are stabilised from their first iteration on, since one has failed without that.
    stabilizes: bool,
    /// Whether steps begin with elastic elements, since one has failed without that.
    begins_elastic: bool,
    /// Whether the last step that failed might have begun so.
    may_begin_elastic: bool,
    /// Why the tangent of the step was singular, in this attempt or one before.
    singular_cause: Option<String>,
    /// Whether a body moved on freely at the end of the last step, with contact stabilisation.
    unrestrained: bool,
    pub(super) root_gather: RootGather,
    phases: Phases,
    /// Whether the last step ended at a singular system.
    singular: bool,
    /// Why the last step would better be shorter.
    coarse: Option<String>,
    warned: bool,
    /// Where the deck names the linear solver.
    solver_place: Option<Place>,
    /// Whether the run has been warned that multipliers are not condensed.
    warned_of_multipliers: bool,
    pub(super) messages: Vec<Diagnostic>,
    pub(super) energy_balance: EnergyBalance,
    /// Balance of the step that has just converged.
    pub(super) balance: Option<Balance>,
    /// Bodies of the part, once a state has converged.
    bodies: Option<NumberedBodies>,
    /// Whether the run has been warned of bodies out of balance.
    warned_of_balance: bool,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Self")]
struct NewtonState {
    failed: bool,
    /// Whether redundant constraints, and multipliers that are not condensed, have been warned of.
    warned: [bool; 2],
    scheme: Option<Box<dyn State>>,
    solver: Option<Box<dyn State>>,
    assembler: AssemblerState,
    energy_balance: EnergyBalance,
}

stored_as_bytes!(NewtonState);

#[typetag::serde(name = "newton_raphson")]
impl State for NewtonState {
    fn remap(&mut self, mapper: &mut dyn StateMapper) {
        self.assembler.remap(mapper);
        self.scheme.iter_mut().chain(&mut self.solver).for_each(|state| state.remap(mapper));
        self.energy_balance.remap(mapper);
    }
}

impl SolutionStrategy for NewtonRaphson {
    fn assembler(&self) -> &Assembler {
        &self.assembler
    }

    fn messages(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.messages)
    }

    fn phases(&self) -> Phases {
        self.phases.clone()
    }

    fn state(&self) -> Option<Box<dyn State>> {
        Some(Box::new(NewtonState {
            failed: self.failed,
            warned: [self.warned, self.warned_of_multipliers],
            scheme: self.scheme.state(),
            solver: self.solver.state(),
            assembler: self.assembler.state(),
            energy_balance: self.energy_balance.clone(),
        }))
    }

    fn resume(&mut self, part: &ModelPart, system: &System, state: Box<dyn State>) -> Result<()> {
        let NewtonState { failed, warned, scheme, solver, assembler, energy_balance } = state.take()?;
        let unknowns = system.dofs.len();
        (self.failed, self.energy_balance) = (failed, energy_balance);
        [self.warned, self.warned_of_multipliers] = warned;
        self.assembler.resume(part, system, assembler)?;
        scheme.map_or(Ok(()), |state| self.scheme.resume(state))?;
        let forces = self.scheme.kept().map_or(unknowns, |forces| forces.len());
        if forces != unknowns || !self.energy_balance.is_of(unknowns) {
            return Err(unfit("the forces it remembers are not those of its unknowns"));
        }
        solver.map_or(Ok(()), |state| self.solver.resume(state))?;
        Ok(())
    }

    fn other_way(&mut self, failed: &StepRecord) -> Option<&'static str> {
        let lets_go = self.singular_cause.is_some() || failed.has_diverged();
        if !self.stabilizes && self.stabilization_length.is_some() && lets_go {
            self.stabilizes = true;
            return Some("with contact stabilization");
        }
        let NewtonSettings { linear, line_search, line_search_after_failure, .. } = &self.settings;
        let may = line_search_after_failure.is_some() && line_search.is_none() && !linear;
        self.searches = may && !self.searches && failed.failed_to_converge();
        if self.searches {
            return Some("with a line search");
        }
        if self.may_begin_elastic && !self.begins_elastic {
            self.begins_elastic = true;
            return Some("with elastic elements until contact has settled");
        }
        None
    }

    fn solve_step(
        &mut self,
        part: &mut ModelPart,
        system: &mut System,
        monitor: &mut dyn Monitor,
    ) -> Result<StepRecord> {
        (self.singular, self.unrestrained) = (false, false);
        self.coarse = None;
        let record = recorded(part, system, |part, system| self.iterate(part, system, monitor));
        self.end_elastic(part);
        self.failed = !record.as_ref().is_ok_and(|record| record.converged);
        if record.as_ref().is_ok_and(|record| !record.converged) {
            self.may_begin_elastic = self.may_begin_elastic(part, system);
        }
        let (coarse, balance) = (self.coarse.take(), self.balance.take());
        Ok(StepRecord { singular: self.singular, unrestrained: self.unrestrained, coarse, balance, ..record? })
    }

    fn finalize_step(&mut self, part: &mut ModelPart, system: &mut System) -> Result<()> {
        if self.scheme.keeps_forces()
            && let Some(inertia) = self.scheme.inertia(part, &system.dofs)
        {
            let forces = self.assembler.inertia_forces(part, system, &inertia)?;
            self.scheme.keep(forces);
        }
        self.assembler.extrapolate_rates(part, system);
        if self.scheme.has_inertia() && !system.interactions.is_empty() {
            self.measure_energy(part, system)?;
        }
        (self.searches, self.stabilizes, self.begins_elastic) = (false, false, false);
        self.singular_cause = None;
        self.energy_balance.accept();
        let start = Instant::now();
        let accepted = accept(part, system);
        self.phases.since("accept", start);
        accepted
    }

    fn linearized(&mut self) -> Option<&mut dyn Linearized> {
        Some(self)
    }

    fn takes_followers(&self) -> bool {
        !self.settings.linear
    }
}

impl Linearized for NewtonRaphson {
    fn out_of_balance(&mut self, part: &ModelPart, system: &System) -> Result<Vec<f64>> {
        let inertia = self.scheme.inertia(part, &system.dofs);
        self.assembler.residual_beside(part, system, inertia.as_ref())
    }

    fn answer(&mut self, part: &ModelPart, system: &System, out_of_balance: &[f64]) -> Result<Vec<f64>> {
        self.solver.set_forcing_term(0.0);
        let rhs = self.assembler.equations().reduce(out_of_balance);
        let solved = self.solve(part, system, &rhs)?;
        Ok(self.assembler.equations().expand(&solved.increment))
    }
}

impl NewtonRaphson {
    /// The iteration over the system that `assembler` assembles.
    pub fn new(
        settings: NewtonSettings,
        scheme: Box<dyn Scheme>,
        criterion: Box<dyn ConvergenceCriterion>,
        solver: Box<dyn LinearSolver>,
        assembler: Assembler,
    ) -> Self {
        Self {
            settings,
            scheme,
            criterion,
            solver,
            assembler,
            stabilization_length: None,
            stabilizes: false,
            begins_elastic: false,
            may_begin_elastic: false,
            singular_cause: None,
            unrestrained: false,
            root_gather: RootGather::default(),
            failed: false,
            searches: false,
            phases: Phases::default(),
            singular: false,
            coarse: None,
            warned: false,
            solver_place: None,
            warned_of_multipliers: false,
            messages: Vec::new(),
            energy_balance: EnergyBalance::default(),
            balance: None,
            bodies: None,
            warned_of_balance: false,
        }
    }

    /// Where the deck names the linear solver, for warnings.
    pub fn solver_named_at(&mut self, place: Place) {
        self.solver_place = Some(place);
    }

    /// Lets PETSc solve the equations of all ranks, each with its own rows, in place of rank 0.
    #[cfg(feature = "petsc")]
    pub fn solve_by_petsc(
        &mut self,
        communicator: zelus_petsc::Communicator,
        settings: zelus_petsc::PetscSettings,
        multipliers: Multipliers,
    ) {
        let condensing = if let Multipliers::Condense(settings) = multipliers { Some(settings) } else { None };
        self.root_gather.petsc =
            Some(super::petsc_rows::PetscRows::new(self.assembler.ranks(), communicator, settings, condensing));
    }

    /// Keeps the balance of a converged state; `more` are loads that the assembler does not know of. Gives the body that is out
    /// of balance where the settings require balance: such a state must not be accepted. Collective.
    pub(super) fn keep_balance(
        &mut self,
        part: &ModelPart,
        system: &System,
        residual: &[f64],
        references: &References,
        more: Option<&[f64]>,
    ) -> Result<Option<Imbalance>> {
        let start = Instant::now();
        let inertia = self.scheme.inertia(part, &system.dofs);
        let balance =
            self.energy_balance.balance(part, system, &mut self.assembler, residual, inertia.as_ref(), more)?;
        self.balance = Some(balance);
        let rule = self.settings.body_balance;
        let imbalance = match rule {
            BodyBalance::Unchecked => None,
            BodyBalance::Required | BodyBalance::Told => self.imbalance(part, system, residual, references),
        };
        self.phases.since("balance", start);
        if rule == BodyBalance::Required {
            if imbalance.is_some() {
                self.balance = None;
            }
            return Ok(imbalance);
        }
        if let Some(imbalance) = imbalance
            && !std::mem::replace(&mut self.warned_of_balance, true)
        {
            let remedy =
                "lower \"residual_relative_tolerance\", or set \"check_body_balance\" to true, which iterates on";
            let fact = format!("step {}: {}", part.info.step, imbalance.fact());
            self.messages.push(Diagnostic::warning("out-of-balance", fact).remedy(remedy));
        }
        Ok(None)
    }

    /// The body that is farthest out of balance in the state whose balance was taken last; collective.
    fn imbalance(
        &mut self,
        part: &ModelPart,
        system: &System,
        residual: &[f64],
        references: &References,
    ) -> Option<Imbalance> {
        let forces = self.energy_balance.pending_forces()?;
        let bodies = self.bodies.get_or_insert_with(|| NumberedBodies::of(part));
        let tolerance = self.criterion.residual_tolerance().unwrap_or(BALANCE_TOLERANCE);
        let balanced = self.assembler.equations().balanced(residual);
        let start = references.start.first()?;
        let groups = BodyDofs::new(bodies, system, &self.assembler);
        Imbalance::largest(&groups, part, [&balanced, start], residual, forces, tolerance)
    }

    /// Notes the energy of the present state where it is the largest so far.
    fn measure_energy(&mut self, part: &mut ModelPart, system: &System) -> Result<()> {
        let most = part.info.value_or(ENERGY_OF_MOTION, 0.0).max(self.assembler.energy(part, system)?);
        part.info.values.insert(ENERGY_OF_MOTION, most);
        Ok(())
    }

    /// Solves the present system; nothing out of balance needs no solver.
    ///
    /// # Errors
    /// A singular matrix or a solver that fails, naming nodes.
    pub(super) fn solve(&mut self, part: &ModelPart, system: &System, rhs: &[f64]) -> Result<Solved, Failed> {
        if !part.ranks.any(rhs.iter().any(|v| *v != 0.0)) {
            let engine = "none: nothing out of balance".to_owned();
            let increment = vec![0.0; rhs.len()];
            return Ok(Solved { increment, relative_residual: 0.0, iterations: 0, engine, fallback: None });
        }
        let (solver, root_gather) = (self.solver.as_mut(), &mut self.root_gather);
        let (start, assembling) = (Instant::now(), self.assembler.seconds.bulk);
        let solved = linear_solve::solve(&mut self.assembler, solver, root_gather, rhs, &system.dofs, &part.nodes);
        let known = solved.as_ref().map_or([0.0; 2], |(_, report)| [report.seconds_symbolic, report.seconds_numeric]);
        self.phases.add("linear: order", known[0]);
        self.phases.add("linear: factor", known[1]);
        // With the time of engines that gave no solution.
        let known = known[0] + known[1] + self.assembler.seconds.bulk - assembling;
        self.phases.add("linear: solve", start.elapsed().as_secs_f64() - known);
        let (increment, report) = solved.map_err(|failed| failed.in_part(part))?;
        let SolveReport { engine, relative_residual, iterations, mut fallback, .. } = report;
        if let Some(refused) = self.solver.not_condensed().or(self.root_gather.not_condensed()) {
            // Said once, and with the names of nodes.
            fallback = None;
            if !std::mem::replace(&mut self.warned_of_multipliers, true) {
                let unknowns = self.assembler.equations().unknowns();
                let dof_name = |equation: usize| match self.assembler.numbering() {
                    Some(_) => self.root_gather.dof_name(equation),
                    None => unknowns.get(equation).map(|&number| DofName::of(&system.dofs, &part.nodes, number)),
                };
                self.messages.push(condensing::warning(refused, &dof_name, self.solver_place.as_ref()));
            }
        }
        Ok(Solved { increment, relative_residual, iterations, engine: engine.to_owned(), fallback })
    }

    /// Verdict of the criterion on the state after an iteration.
    pub(super) fn judge(
        &self,
        part: &ModelPart,
        system: &System,
        iteration: usize,
        balanced: &[f64],
        references: &References,
        increment: &[f64],
    ) -> Verdict {
        self.criterion.judge(&Measures {
            iteration,
            nodes: &part.nodes,
            slave_nodes: &part.slave_nodes,
            dofs: &system.dofs,
            equations: self.assembler.equations(),
            distribution: self.assembler.distribution(),
            residual: balanced,
            references: &references.start,
            switched: references.switched.as_deref(),
            increment,
            values: &self.assembler.values(part, system),
            round_off: LazyCell::new(Box::new(|| self.assembler.round_off(part, system))),
        })
    }

    /// The first unknown that is no number any more, or whose residual is not, and who gives it; collective.
    pub(super) fn first_infinite(&self, part: &ModelPart, system: &System, residual: &[f64]) -> Option<String> {
        let values = self.assembler.values(part, system);
        let broken = (0..values.len()).find(|&n| !(residual[n].is_finite() && values[n].is_finite())).map(|n| {
            let unknown = DofName::of(&system.dofs, &part.nodes, n as u32);
            if !values[n].is_finite() {
                return format!("{unknown} is {}", values[n]);
            }
            let giver = self.assembler.first_infinite_entity(part, system);
            let giver = giver.map(|giver| format!("; the first to give such forces is {giver}")).unwrap_or_default();
            format!("the residual of {unknown} is {}{giver}", residual[n])
        });
        part.ranks.first_to_say(broken)
    }

    /// Adds an increment to the unknowns; rates and positions follow.
    pub(super) fn move_by(&self, part: &mut ModelPart, system: &System, increment: &[f64]) {
        system.dofs.scatter_add(increment, part);
        if !part.constraints.is_empty() {
            impose_constraints(part);
        }
        self.scheme.update(part);
        if self.settings.move_mesh {
            part.nodes.move_all();
        }
    }

    /// Moves by the part of `increment` that the line search finds, and shortens it to that.
    fn search(
        &mut self,
        search: &LineSearch,
        part: &mut ModelPart,
        system: &System,
        residual: &[f64],
        increment: &mut [f64],
    ) -> Result<()> {
        let begin = self.assembler.values(part, system);
        let before = self.assembler.dot(increment, residual);
        let go = |newton: &mut Self, part: &mut ModelPart, factor: f64| {
            let now = newton.assembler.values(part, system);
            let way = begin.iter().zip(&now).zip(increment.iter());
            let way: Vec<f64> = way.map(|((begin, now), d)| begin + factor * d - now).collect();
            newton.move_by(part, system, &way);
        };
        let mut last = 0.0;
        let factor = search.search(before, |factor| {
            go(self, part, factor);
            last = factor;
            let inertia = self.scheme.inertia(part, &system.dofs);
            match self.assembler.residual(part, system, inertia.as_ref()) {
                Ok(residual) => Ok(Some(self.assembler.dot(increment, &residual)).filter(|w| w.is_finite())),
                Err(error) if is_of_entities(&error) => Ok(None),
                Err(error) => Err(error),
            }
        })?;
        if factor != last {
            go(self, part, factor);
        }
        increment.iter_mut().for_each(|d| *d *= factor);
        Ok(())
    }

    /// Warns, once a run, that one solve does not balance a model whose analysis is to be linear.
    fn warn_of_nonlinearity(&mut self, imbalance: &Imbalance) {
        if !std::mem::replace(&mut self.warned_of_balance, true) {
            let fact = format!("\"analysis_type\" is \"linear\", but after one solve {}", imbalance.fact());
            let remedy = "the model is nonlinear, and is iterated on; set \"analysis_type\" to \"non_linear\"";
            self.messages.push(Diagnostic::warning("linear-analysis", fact).remedy(remedy));
        }
    }

    /// Warns, once a run, of redundant constraints of interactions.
    pub(super) fn warn_of_redundancy(&mut self, why: &str) {
        if std::mem::replace(&mut self.warned, true) {
            return;
        }
        let fact = format!("{}; solved with relaxed constraints", why.lines().next().unwrap_or_default());
        let remedy = "if supports hold both sides of an interface at its edge, leave those nodes out of it; the answer \
                      obeys all constraints, their multipliers are one choice of many";
        self.messages.push(Diagnostic::warning("redundant-constraints", fact).remedy(remedy));
    }

    /// Largest over smallest size of an eigenvalue of the system (eq. 4.18), by Lanczos' method; on several ranks, rank 0 knows
    /// it. Collective.
    fn condition_number(&mut self, part: &ModelPart, system: &System, monitor: &mut dyn Monitor) -> Option<f64> {
        self.assembler.reduce();
        let mut matrices = self.assembler.system();
        if self.assembler.numbering().is_some() {
            self.root_gather.update(&self.assembler, None, &system.dofs, &part.nodes);
            matrices = self.root_gather.system(&matrices).0;
        }
        if !part.ranks.is_root() {
            return None;
        }
        match zelus_linear_algebra::condition_number(&matrices) {
            Ok(spectrum) => {
                if !spectrum.converged {
                    monitor.note("condition number: an estimate, Lanczos' method has not converged");
                }
                Some(spectrum.condition_number())
            }
            Err(error) => {
                monitor.note(&format!("condition number: {error}"));
                None
            }
        }
    }

    /// The largest out-of-balance entry and its unknown, in words; collective.
    pub(super) fn largest_residual(&self, part: &ModelPart, system: &System, balanced: &[f64]) -> Option<String> {
        let size = |n: u32| balanced[n as usize].abs();
        let unknowns = self.assembler.equations().unknowns().iter().copied();
        let worst = unknowns.max_by(|&a, &b| size(a).total_cmp(&size(b)));
        let largest = part.ranks.gather_numbers(&[worst.map_or(-1.0, size)]).concat().into_iter().fold(-1.0, f64::max);
        let said = worst.filter(|&n| size(n) >= largest).map(|n| {
            let value = balanced[n as usize];
            let at = location(part, system.dofs.dofs()[n as usize].node);
            format!("; largest residual {value:.3e} at {}{at}", DofName::of(&system.dofs, &part.nodes, n))
        });
        part.ranks.first_to_say(said)
    }

    pub(super) fn explain(
        &self,
        part: &ModelPart,
        system: &System,
        records: &[IterationRecord],
        residual: &[f64],
    ) -> String {
        let equations = self.assembler.equations();
        let residual = equations.balanced(residual);
        let worst = self.largest_residual(part, system, &residual);
        let last = records.last();
        let cycling = last.filter(|r| r.active_set_changes + r.stick_slip_changes > 0).map(|r| {
            let nodes: Vec<String> = r.changed_nodes.iter().map(ToString::to_string).collect();
            let described: Vec<String> =
                r.changed_nodes.iter().take(DESCRIBED).filter_map(|&id| state_of(part, system, id)).collect();
            format!("; the contact state of nodes {} still changes: {}", nodes.join(" "), described.join("; "))
        });
        format!(
            "not converged in {} iteration{}{}{}",
            records.len(),
            if records.len() == 1 { "" } else { "s" },
            worst.unwrap_or_default(),
            cycling.unwrap_or_default()
        )
    }
}

/// Position of a node and its state in an interaction, where it has one.
fn state_of(part: &ModelPart, system: &System, id: usize) -> Option<String> {
    let node = part.nodes.ids.binary_search(&id).ok()? as u32;
    let state = system.interactions.iter().find_map(|interaction| interaction.node_state(node))?;
    Some(format!("node {id}{} {state}", location(part, node)))
}
