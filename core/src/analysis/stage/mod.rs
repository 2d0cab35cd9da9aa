//! One stage: a solver, its processes, and the loop over the steps.
//!
//! A stage is prepared in five phases, each of which hands a value of its own to the next: the deck is parsed, mesh and
//! materials are read, the ranks share the mesh, processes, system and strategy are built, and the whole is checked.

mod attempts;
mod built_stage;
mod deck_check;
mod messages;
mod parsed_stage;
mod problems_of_ranks;
mod read_stage;
mod request;
mod run_context;
mod schedule;
mod shared_stage;
mod support_reactions;

use std::path::PathBuf;
use std::time::Instant;

use super::contents::Contents;
use super::driver::{Driver, LoopPoint};
use super::large_motion::LargeMotion;
use super::report::{Body, RunReport};
use super::saved_run::{SavedStage, resume_blocks, resume_each, states_of};
use crate::assembly::System;
use crate::communication::Ranks;
use crate::diagnostics::{Diagnostic, Report, Result, unfit};
use crate::io::{Claim, FileUse};
use crate::model::Model;
use crate::processes::{Extremes, Process};
use crate::strategies::{ONLY_CONTACT_RESTRAINS, Plan, SolutionStrategy};

use self::built_stage::BuiltStage;
use self::deck_check::check;
use self::messages::{messages_of, tell};
use self::parsed_stage::ParsedStage;
use self::read_stage::ReadStage;
use self::schedule::Schedule;
use self::shared_stage::SharedStage;

pub(super) use self::request::StageRequest;
pub(super) use self::run_context::{RunContext, Systems};

/// A stage that is ready to run.
pub(super) struct Stage {
    name: String,
    root: String,
    system: System,
    schedule: Schedule,
    /// Length to begin the next step with, where the last one had to be shortened.
    first_length: Option<f64>,
    strategy: Box<dyn SolutionStrategy>,
    processes: Vec<Box<dyn Process>>,
    files: Vec<FileUse>,
    /// Digests of what it has read beside deck and mesh.
    contents: Contents,
    /// Largest displacement and strain of the accepted steps.
    largest: LargeMotion,
    /// The outputs that no other run may write meanwhile; `None` before the first step.
    claims: Option<Vec<Claim>>,
    begun: bool,
}

impl Stage {
    /// Reads mesh and materials, makes processes, blocks and strategy, and checks them: everything short of solving. Collective.
    ///
    /// # Errors
    /// Every problem of the deck that can be found, gathered.
    pub(super) fn prepare(request: StageRequest<'_>, run: &mut RunContext<'_>) -> Result<Self> {
        run.monitor.phase("read");
        let start = Instant::now();
        let parsed = ParsedStage::parse(&request, run.report, run.monitor)?;
        let StageRequest { folders, more, outputs, .. } = request;
        let read = ReadStage::read(parsed, &folders.deck, run.model)?;
        run.report.add_seconds("read", start.elapsed().as_secs_f64());
        run.monitor.phase("set up");
        let start = Instant::now();
        let shared = SharedStage::share(read, folders, run)?;
        let built = BuiltStage::build(shared, folders, more, outputs, run)?;
        let (told, contact_restrains) = check(&built, run.model)?;
        tell(told, run.report, run.monitor);
        if let Some(contact_restrains) = contact_restrains {
            run.model.root_mut(&built.root)?.info.set(ONLY_CONTACT_RESTRAINS, contact_restrains);
        }
        run.driver.at(LoopPoint::Ready, &built.root, run.model, &built.system, &mut |_| Ok(()))?;
        run.report.add_seconds("set up", start.elapsed().as_secs_f64());
        Ok(Self::new(built))
    }

    /// A stage before its first step.
    fn new(built: BuiltStage) -> Self {
        let BuiltStage { name, root, schedule, system, strategy, processes, files, contents, .. } = built;
        Self {
            name,
            root,
            system,
            schedule,
            first_length: None,
            strategy,
            processes,
            files,
            contents,
            largest: LargeMotion::default(),
            claims: None,
            begun: false,
        }
    }

    /// Plan of this stage, the first of the `left` remaining stages of `all`.
    pub(super) fn plan(&self, left: usize, all: usize) -> Plan {
        let [start, end] = self.schedule.interval();
        Plan { stage: all - left + 1, stages: all, start, end, steps: self.schedule.stepping.count(start, end) }
    }

    /// Name of the part that it solves for.
    pub(super) fn root(&self) -> &str {
        &self.root
    }

    /// System that computes on that part.
    pub(super) fn system(&self) -> &System {
        &self.system
    }

    /// Keeps other runs from writing the outputs of this one.
    fn claim(&mut self, ranks: &Ranks) -> Result<()> {
        let outputs = self.files.iter().filter_map(FileUse::output).filter(|_| ranks.is_root());
        self.claims = Some(ranks.agree(outputs.map(Claim::of).collect())?);
        Ok(())
    }

    fn begin(&mut self, run: &mut RunContext<'_>) -> Result<()> {
        self.begun = true;
        run.report.stages.push(self.name.clone());
        let processes = &mut self.processes;
        run.driver.at(LoopPoint::BeforeLoop, &self.root, run.model, &self.system, &mut |model| {
            let ranks = model.ranks.clone();
            processes.iter_mut().try_for_each(|process| ranks.agree(process.before_loop(model)))
        })?;
        run.model.root_mut(&self.root)?.info.time = self.schedule.start_time;
        for process in &mut self.processes {
            run.model.ranks.clone().agree(process.print_start(run.model, &self.system))?;
        }
        Ok(())
    }

    /// Where processes want the run to be saved now.
    pub(super) fn saves(&mut self, model: &Model) -> Vec<PathBuf> {
        self.processes.iter_mut().filter_map(|process| process.saves(model)).collect()
    }

    /// Whether one of its processes saves the run now and then.
    pub(super) fn saves_runs(&self) -> bool {
        self.processes.iter().any(|process| process.saves_runs())
    }

    /// State between steps.
    pub(super) fn state(&self) -> SavedStage {
        SavedStage {
            begun: self.begun,
            contents: self.contents.clone(),
            first_length: self.first_length,
            unknowns: self.system.dofs.layout(),
            strategy: self.strategy.state(),
            elements: states_of(&self.system.elements),
            conditions: states_of(&self.system.conditions),
            interactions: self.system.interactions.iter().map(|interaction| interaction.state()).collect(),
            processes: self.processes.iter().map(|process| process.state()).collect(),
        }
    }

    /// Restores its state between steps; `model` is the saved one.
    ///
    /// # Errors
    /// States of another deck; files of output that are not there any more.
    pub(super) fn resume(&mut self, model: &mut Model, state: SavedStage) -> Result<()> {
        self.contents.check(&state.contents)?;
        (self.begun, self.first_length) = (state.begun, state.first_length);
        let part = model.root_mut(&self.root)?;
        let begins = !self.begun || part.info.time >= self.schedule.start_time && part.info.time.is_finite();
        if !begins || state.first_length.is_some_and(|length| !(length > 0.0 && length.is_finite())) {
            return Err(unfit("it stands at no time of the run"));
        }
        resume_blocks(&mut self.system.elements, state.elements)?;
        resume_blocks(&mut self.system.conditions, state.conditions)?;
        resume_each(&mut self.system.interactions, state.interactions, "interactions", |own, state| {
            own.resume(part, state)
        })?;
        if let Some(state) = state.strategy {
            self.strategy.resume(part, &self.system, state)?;
        }
        let ranks = model.ranks.clone();
        resume_each(&mut self.processes, state.processes, "processes", |own, state| {
            ranks.agree(own.resume(model, state))
        })
    }

    /// Makes the next step of the deck, in several shorter ones where it does not converge; `false` when none is left.
    ///
    /// # Errors
    /// A step that does not converge, however short; a failed solver, process or file.
    pub(super) fn step(&mut self, run: &mut RunContext<'_>) -> Result<bool> {
        if self.claims.is_none() {
            self.claim(&run.model.ranks)?;
        }
        if !self.begun {
            self.begin(run)?;
        }
        let part = run.model.root_mut(&self.root)?;
        let time = part.info.time;
        if time >= self.schedule.end_time {
            if time > self.schedule.end_time {
                let ends = format!("the last step ends at {time}, after \"end_time\" {}", self.schedule.end_time);
                run.monitor
                    .note(&format!("{ends}: \"last_step\": \"shortened\" in \"time_stepping\" would end it there"));
            }
            let last = self.system.interactions.iter().flat_map(|interaction| interaction.last_messages(part));
            let mut last: Vec<Diagnostic> = last.chain(self.strategy.last_messages(part)).collect();
            // Explicit steps are too many to look at each.
            if part.info.solver.explicit {
                self.largest.see(part, &self.system);
            }
            last.extend(self.largest.warnings(part));
            last.extend(self.processes.iter().flat_map(|process| process.last_messages(run.model)));
            tell(run.model.ranks.problems_of_all(last), run.report, run.monitor);
            return Ok(false);
        }
        let length = self.strategy.step_length(part, &self.system, self.schedule.stepping.next(time)?)?;
        let chosen = self.strategy.chosen_numbers();
        run.report.parameters.extend(chosen.into_iter().map(|(name, value)| (name.to_owned(), value)));
        let (target, is_shortened) = self.schedule.stepping.target(time, length, self.schedule.interval());
        if is_shortened {
            run.monitor.note(&format!(
                "the last step is shortened from {length} to {:.6e}, to end at {target}",
                target - time
            ));
        }
        self.advance_to(target, run).map(|()| true)
    }

    /// Finalises the processes, also after a step that has failed, or suspends them where the stage is restarted later; the states of
    /// elements go to `systems`.
    ///
    /// # Errors
    /// `result`, the end of the last step, or else the error of a process.
    pub(super) fn finish(
        mut self,
        (result, goes_on): (Result<()>, bool),
        model: &mut Model,
        systems: &mut Systems,
        report: &mut RunReport,
        driver: &mut dyn Driver,
    ) -> Result<()> {
        if result.is_err() {
            model.ranks.announce_failure();
        }
        let mut finals = Report::new();
        let processes = &mut self.processes;
        let finalized = driver.at(LoopPoint::Finalize, &self.root, model, &self.system, &mut |model| {
            for process in processes.iter_mut() {
                let finalized = if goes_on { process.suspend(model) } else { process.finalize(model) };
                finals.absorb(if result.is_ok() { model.ranks.agree(finalized) } else { finalized });
                report.outputs.extend(process.outputs());
            }
            Ok(())
        });
        for (phase, seconds) in self.strategy.phases().iter() {
            report.add_seconds(phase, seconds);
        }
        let assembly = self.strategy.assembler().seconds;
        report.add_seconds("assemble: residual", assembly.residual);
        report.add_seconds("assemble: elements", assembly.bulk);
        report.add_seconds("assemble: interactions", assembly.coupling);
        let part = model.parts.get(&self.root).filter(|_| result.is_ok());
        report.tell_extremes(&part.map(|part| Extremes::of(part, &self.system)).unwrap_or_default());
        report.bodies = part.map(Body::all).unwrap_or_default();
        systems.insert(self.root, System { elements: self.system.elements, ..System::default() });
        result.and(finalized).and(finals.finish().map(|_| ()))
    }

    /// Passes on the messages of processes, interactions and the strategy; collective.
    fn pass_on_messages(&mut self, run: &mut RunContext<'_>) {
        let mut own = self.strategy.messages();
        own.extend(messages_of(&mut self.processes, &mut self.system));
        tell(run.model.ranks.problems_of_all(own), run.report, run.monitor);
    }
}
