//! A deck that is run step by step, with its model and report.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use zelus_linear_algebra::parallel::ThreadPool;

use super::checkpoints::{Checkpoints, LatestRunFile};
use super::deck::{Folders, StageDeck, open, stages};
use super::driver::{Driver, Unattended};
use super::rank_layout::RankLayout;
use super::repartitioning::Repartitioning;
use super::report::RunReport;
use super::saved_run::{LoadedRun, SavedRun, check_mesh, earlier_system, fingerprint, other_deck, states_of, whole};
use super::stage::{RunContext, Stage, StageRequest, Systems};
use super::threads;
use crate::assembly::System;
use crate::communication::Ranks;
use crate::diagnostics::{Diagnostic, Error, Place, Result};
use crate::io::{SavedFile, write_saved};
use crate::model::{Model, ModelPart};
use crate::parameters::Node;
use crate::processes::Process;
use crate::strategies::{Monitor, StepRecord};

/// Options of a [`Simulation`] that its caller chooses.
#[derive(Debug, Clone, Default)]
pub struct RunOptions {
    /// Threads; `None` takes all of the machine.
    pub threads: Option<usize>,
    /// Program whose defaults are used where the deck gives none, e.g. `kratos`; `None` for that of the deck, else our own.
    pub like: Option<String>,
    /// The processes that run the deck together, as [`communication::join`](crate::communication::join) gives them; this one
    /// alone by default.
    pub ranks: Ranks,
    /// Files that the caller will write: none of them may be one that the run reads or writes.
    pub outputs: Vec<PathBuf>,
    /// Values that replace those of the deck, by dotted paths, which may hold places in lists: `problem_data.end_time`,
    /// `processes.loads.0.Parameters.modulus`. They are checked as if the deck said them.
    pub changes: Vec<(String, serde_json::Value)>,
    /// Where relative names of files that are written start; `None` for the folder of the deck.
    pub results: Option<PathBuf>,
}

/// Key of the minutes of the clock after which a run saves itself, 0 for never; and their number where a deck does not give it.
const AUTOSAVE: &str = "problem_data.autosave_minutes";
const MINUTES: f64 = 10.0;

/// Lays the caller's changes over a deck.
fn change(deck: &mut Node, options: &RunOptions) -> Result<()> {
    options.changes.iter().try_for_each(|(key, value)| {
        let place = Place::command_line(key);
        let value = Node::from_json(value, &place)?;
        deck.set_path(key, value).map_err(|problem| problem.at(place).into())
    })
}

/// A deck with its model and the stage under way.
///
/// [`Simulation::step`] makes one step of the deck after another. Between them fields can be read and written; the next step begins
/// with the values written. Several simulations in one process know nothing of each other.
///
/// The monitor is passed to all computations: [`Silent`](crate::strategies::Silent) prints nothing.
///
/// Elements and solvers come from applications, so the page of the crate `zelus`, which links them all, has the example.
pub struct Simulation {
    stages: Vec<StageDeck>,
    /// Stages that are over.
    over: usize,
    stage: Option<Stage>,
    /// The part that the present or the last stage solves for.
    root: String,
    folders: Folders,
    like: Option<String>,
    outputs: Vec<PathBuf>,
    model: Model,
    /// The model as the stage under way found it, where it is not the first.
    before: Option<Model>,
    systems: Systems,
    driver: Box<dyn Driver>,
    /// Processes to act in the next stage.
    more: Vec<Box<dyn Process>>,
    pool: Arc<ThreadPool>,
    report: RunReport,
    /// Warnings of the deck as a whole, which no monitor has heard of.
    untold: Vec<Diagnostic>,
    checkpoints: Checkpoints,
    /// Names the latest saved run of a deck that is a file.
    pointer: Option<LatestRunFile>,
    /// Time of the clock since the run began or was saved.
    unsaved_since: Instant,
    /// Whether the latest saved run was saved by [`Simulation::autosave`].
    autosaved: bool,
}

impl Simulation {
    /// Reads a deck; paths in it are relative to its folder.
    ///
    /// # Errors
    /// A file that cannot be read or is no JSON; stages that are not there; threads that cannot be started.
    pub fn open(path: &Path, options: &RunOptions) -> Result<Self> {
        let (mut deck, folder) = open(path)?;
        change(&mut deck.root, options)?;
        let mut simulation = Self::new(&deck.root, folder, options)?;
        simulation.untold.splice(..0, deck.warnings);
        simulation.pointer = Some(LatestRunFile::of(path, &simulation.folders.results));
        Ok(simulation)
    }

    /// A deck that is in memory; `folder` is where paths in it begin.
    ///
    /// # Errors
    /// As [`Simulation::open`].
    pub fn of_value(deck: &serde_json::Value, folder: &Path, options: &RunOptions) -> Result<Self> {
        let mut deck = Node::from_json(deck, &Place::file("the deck"))?;
        change(&mut deck, options)?;
        Self::new(&deck, folder.to_owned(), options)
    }

    fn new(deck: &Node, folder: PathBuf, options: &RunOptions) -> Result<Self> {
        let (pool, fewer) = threads::pool(options.threads)?;
        let mut report = RunReport { threads: pool.threads(), ..RunReport::default() };
        let stages = stages(deck, &mut report)?;
        let results = options.results.clone().unwrap_or_else(|| folder.clone());
        let folders = Folders { deck: folder, results };
        let checkpoints = Checkpoints::new(deck, &stages, &folders)?;
        Ok(Self {
            stages,
            over: 0,
            stage: None,
            root: String::new(),
            folders,
            like: options.like.clone(),
            outputs: options.outputs.clone(),
            model: Model::new(options.ranks.clone()),
            before: None,
            systems: Systems::new(),
            driver: Box::new(Unattended),
            more: Vec::new(),
            pool: Arc::new(pool),
            report,
            untold: fewer.into_iter().collect(),
            checkpoints,
            pointer: None,
            unsaved_since: Instant::now(),
            autosaved: false,
        })
    }

    /// A process of the caller's, which acts after those of the deck: in the stage that is prepared next.
    pub fn add_process(&mut self, process: Box<dyn Process>) {
        self.more.push(process);
    }

    /// Replaces the driver of the run by one of the caller.
    pub fn set_driver(&mut self, driver: Box<dyn Driver>) {
        self.driver = driver;
    }

    /// Prepares the next stage, when none is under way: mesh, materials, processes, unknowns. Without it [`Simulation::step`]
    /// does so.
    ///
    /// # Errors
    /// Every problem of the deck that can be found without solving, gathered.
    pub fn prepare(&mut self, monitor: &mut dyn Monitor) -> Result<()> {
        self.timed(|simulation| simulation.prepare_stage(monitor))
    }

    /// Makes the next step of the deck; `false` when there was none left, and every process has come to its end.
    ///
    /// # Errors
    /// Problems of the deck, before anything is solved; a step that does not converge, however short; a failed solver, process or file.
    /// Processes have then come to their end, and the converged steps are written.
    pub fn step(&mut self, monitor: &mut dyn Monitor) -> Result<bool> {
        self.timed(|simulation| simulation.next_step(monitor))
    }

    /// Makes all steps that are left.
    ///
    /// # Errors
    /// As [`Simulation::step`].
    pub fn run(&mut self, monitor: &mut dyn Monitor) -> Result<()> {
        self.timed(|simulation| {
            while simulation.next_step(monitor)? {}
            Ok(())
        })
    }

    /// Ends here, before the last step: every process comes to its end and writes its results.
    ///
    /// # Errors
    /// A process or file that fails.
    pub fn finish(&mut self) -> Result<()> {
        self.end_early(false)
    }

    fn end_early(&mut self, is_suspended: bool) -> Result<()> {
        let ended = self.timed(|simulation| simulation.end_stage(Ok(()), is_suspended));
        self.over = self.stages.len();
        self.report.converged = false;
        ended
    }

    /// Does everything that can be known of all stages without solving.
    ///
    /// # Errors
    /// Every problem of the first stage that has any.
    pub fn check(&mut self, monitor: &mut dyn Monitor) -> Result<()> {
        self.timed(|simulation| {
            while simulation.over < simulation.stages.len() {
                simulation.prepare_stage(monitor)?;
                simulation.stage = None;
                simulation.report.stages.push(simulation.stages[simulation.over].name.clone());
                simulation.over += 1;
            }
            Ok(())
        })
    }

    /// Saves the run as it stands between two steps, whole: fields, states, reports, of several ranks in one file. Collective.
    ///
    /// # Errors
    /// A disk that refuses; the file that was there is then untouched.
    pub fn save(&self, path: &Path) -> Result<()> {
        let run = SavedRun {
            deck: self.fingerprint(),
            over: self.over,
            root: self.root.clone(),
            before: self.before.as_ref(),
            model: &self.model,
            systems: self.systems.iter().map(|(root, system)| (root.clone(), states_of(&system.elements))).collect(),
            stage: self.stage.as_ref().map(Stage::state),
            report: &self.report,
            mesh: self.checkpoints.mesh.clone(),
        };
        write_saved(&self.model.ranks, path, &run)
    }

    /// Saves the run beside its deck, where [`Simulation::resume`] finds it, and ends here: every process writes its results.
    ///
    /// # Errors
    /// A deck that is no file; a disk that refuses, a process that fails.
    pub fn suspend(&mut self) -> Result<PathBuf> {
        let pointer = self.pointer.as_ref();
        let path = pointer.map(LatestRunFile::beside).ok_or_else(|| Error::System("the deck is no file".to_owned()))?;
        self.save_named(&path)?;
        self.end_early(true)?;
        Ok(path)
    }

    /// Saves the run beside its deck, as [`Simulation::suspend`] does, and continues, where more than `autosave_minutes` of the clock have
    /// passed since it was saved and no process of the deck saves it; the file where it was saved. Collective.
    ///
    /// # Errors
    /// A disk that refuses.
    pub fn autosave(&mut self) -> Result<Option<PathBuf>> {
        let (Some(stage), Some(settings)) = (&self.stage, self.stages.get(self.over)) else { return Ok(None) };
        let minutes = settings.settings.get_path(AUTOSAVE).and_then(Node::as_f64).unwrap_or(MINUTES);
        let is_due = minutes > 0.0 && self.unsaved_since.elapsed().as_secs_f64() > 60.0 * minutes;
        let Some(path) = self.pointer.as_ref().map(LatestRunFile::beside).filter(|_| !stage.saves_runs()) else {
            return Ok(None);
        };
        // The clock of one rank decides for all.
        if !self.model.ranks.any(is_due && self.model.ranks.is_root()) {
            return Ok(None);
        }
        self.save_named(&path)?;
        (self.unsaved_since, self.autosaved) = (Instant::now(), true);
        Ok(Some(path))
    }

    /// Removes the run that [`Simulation::autosave`] has saved: its end is reached.
    pub fn remove_autosave(&mut self) {
        let Some(pointer) = self.pointer.as_ref().filter(|_| std::mem::take(&mut self.autosaved)) else { return };
        if self.model.ranks.is_root() {
            pointer.remove();
        }
    }

    /// Goes on from the latest saved run of the deck, by its process `save_restart_process`, its checkpoints or
    /// [`Simulation::suspend`]; the file, or `None` where none has been saved.
    ///
    /// # Errors
    /// As [`Simulation::load`].
    pub fn resume(&mut self, monitor: &mut dyn Monitor) -> Result<Option<PathBuf>> {
        let named = self.model.ranks.agree(self.pointer.as_ref().map_or(Ok(None), LatestRunFile::read))?;
        let Some(path) = named else { return Ok(None) };
        self.load(&path, monitor)?;
        Ok(Some(path))
    }

    /// Continues from a saved run of the same deck: further results are bitwise identical, on any number of threads; on another number
    /// of ranks they differ by round-off. Nothing may be prepared yet; processes of the caller's are added before.
    ///
    /// Meshes are read again. Output files that grow are cut to their length at the time of saving.
    ///
    /// # Errors
    /// A file that is no whole saved run, or one of another deck or mesh; problems of the deck.
    pub fn load(&mut self, path: &Path, monitor: &mut dyn Monitor) -> Result<()> {
        self.timed(|simulation| simulation.load_run(path, monitor))
    }

    /// The model: all parts with their nodes, fields, elements and properties.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The model, to write fields, fixities or properties of.
    pub fn model_mut(&mut self) -> &mut Model {
        &mut self.model
    }

    /// The part that the stage under way, or the last one, solves for; `None` before the first is prepared.
    pub fn part(&self) -> Option<&ModelPart> {
        self.model.parts.get(&self.root)
    }

    /// Unknowns, blocks and interactions of the stage under way.
    pub fn system(&self) -> Option<&System> {
        self.stage.as_ref().map(Stage::system)
    }

    /// Numbers of a field with history at the end of the last step (`components` a node), in the order of `part().nodes`; `None`
    /// when nodes have no such variable.
    pub fn field(&self, name: &str) -> Option<&[f64]> {
        self.part()?.nodes.history.get(name).map(|field| &*field.levels[0])
    }

    /// As [`Simulation::field`], to write.
    pub fn field_mut(&mut self, name: &str) -> Option<&mut [f64]> {
        let field = self.model.parts.get_mut(&self.root)?.nodes.history.get_mut(name)?;
        field.levels.first_mut().map(|level| &mut **level)
    }

    /// The time that is reached in the stage under way.
    pub fn time(&self) -> Option<f64> {
        self.part().map(|part| part.info.time)
    }

    /// Records of all attempts at steps so far.
    pub fn records(&self) -> &[StepRecord] {
        &self.report.steps
    }

    /// The report up to now.
    pub fn report(&self) -> &RunReport {
        &self.report
    }

    /// The report, at the end.
    pub fn into_report(mut self) -> RunReport {
        self.measure_memory();
        self.report
    }

    /// As [`Simulation::save`], and as the latest.
    fn save_named(&self, path: &Path) -> Result<()> {
        self.save(path)?;
        self.pointer.as_ref().map_or(Ok(()), |pointer| pointer.write(&self.model.ranks, path))
    }

    fn fingerprint(&self) -> u32 {
        fingerprint(&self.stages, self.like.as_deref())
    }

    fn load_run(&mut self, path: &Path, monitor: &mut dyn Monitor) -> Result<()> {
        let ranks = self.model.ranks.clone();
        let file = ranks.agree(SavedFile::open(path))?;
        // Each rank restores its own state; on another number of ranks, its share of all states.
        let same = file.ranks() == ranks.size();
        let wanted = if same { ranks.rank()..ranks.rank() + 1 } else { 0..file.ranks() };
        let runs: Vec<LoadedRun> = ranks.agree(wanted.map(|rank| file.read(rank)).collect())?;
        if !same {
            let (were, are) = (file.ranks(), ranks.size());
            monitor.note(&format!("saved by {were} ranks, restarted on {are}: results agree to round-off"));
        }
        let here = Place::file(path);
        self.restore_runs(runs, !same, monitor).map_err(|error| error.at(&here))
    }

    /// Takes up the run of this rank or, where they are to be `repartitioned`, the runs of all ranks that were.
    fn restore_runs(&mut self, mut runs: Vec<LoadedRun>, repartitioned: bool, monitor: &mut dyn Monitor) -> Result<()> {
        let ranks = self.model.ranks.clone();
        if self.stage.is_some() || self.over > 0 {
            return Err(other_deck("the simulation has begun already"));
        }
        let deck = self.fingerprint();
        ranks.agree(runs.iter().try_for_each(|run| run.check(deck, self.stages.len())))?;
        self.checkpoints.from = None;
        self.checkpoints.name_mesh(&mut self.stages, runs[0].mesh.take());
        self.over = runs[0].over;
        let root = runs[0].root.clone();
        let report = std::mem::take(&mut runs[0].report);
        let were: Vec<RankLayout> = if repartitioned {
            runs.iter().enumerate().filter_map(|(rank, run)| run.layout_of(rank)).collect()
        } else {
            Vec::new()
        };
        let (mut models, mut before, mut systems, mut stages) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for run in runs {
            models.push(run.model);
            before.extend(run.before);
            systems.push(run.systems);
            stages.extend(run.stage);
        }
        let mut model = whole(models)?.shared_by(&ranks);
        self.model = if before.is_empty() { Model::new(ranks.clone()) } else { whole(before)?.shared_by(&ranks) };
        for root in systems[0].keys().cloned().collect::<Vec<_>>() {
            let part = self.model.parts.get(&root).map_or_else(|| model.root(&root), Ok)?;
            let states = systems.iter_mut().filter_map(|of_rank| of_rank.remove(&root)).collect();
            self.systems.insert(root, earlier_system(part, states, repartitioned)?);
        }
        if stages.is_empty() {
            self.model = model;
        } else {
            self.prepare_stage(monitor)?;
            let stage = self.stage.as_mut().expect("just prepared");
            let part = self.model.root(&self.root)?;
            let state = if repartitioned {
                let cut = model.parts.remove(&self.root).map(|saved| saved.cut_like(part)).transpose();
                model.parts.extend(cut.map_err(other_deck)?.map(|part| (self.root.clone(), part)));
                Repartitioning::new(were, part, stage.system()).stage(stages, stage.state(), stage.system())?
            } else {
                stages.swap_remove(0)
            };
            check_mesh(model.root(&self.root)?, part)?;
            model.root_mut(&self.root)?.interface_surfaces.clone_from(&part.interface_surfaces);
            self.model = model;
            stage.resume(&mut self.model, state)?;
        }
        self.root = root;
        let threads = self.report.threads;
        self.report = RunReport { threads, ..report };
        Ok(())
    }

    fn prepare_stage(&mut self, monitor: &mut dyn Monitor) -> Result<()> {
        if self.stage.is_some() || self.over == self.stages.len() {
            return Ok(());
        }
        if let Some(from) = self.checkpoints.from.take() {
            self.load_run(&from.path, monitor).map_err(|error| error.at(&from.place))?;
            return self.prepare_stage(monitor);
        }
        for warning in std::mem::take(&mut self.untold) {
            self.report.warnings.push(warning.to_string());
            monitor.warn(&warning);
        }
        let more = std::mem::take(&mut self.more);
        self.before = (self.over > 0).then(|| self.model.clone());
        let stages = &self.stages[self.over..];
        let (folders, outputs) = (&self.folders, &self.outputs);
        let request = StageRequest { stages, folders, like: self.like.as_deref(), more, outputs };
        let mut run = RunContext {
            model: &mut self.model,
            systems: &mut self.systems,
            report: &mut self.report,
            monitor,
            driver: self.driver.as_mut(),
        };
        let stage = Stage::prepare(request, &mut run)?;
        stage.root().clone_into(&mut self.root);
        monitor.begin_stage(&stage.plan(stages.len(), self.stages.len()));
        self.stage = Some(stage);
        Ok(())
    }

    fn next_step(&mut self, monitor: &mut dyn Monitor) -> Result<bool> {
        while self.over < self.stages.len() {
            self.prepare_stage(monitor)?;
            // A saved run may have been at its end.
            let Some(stage) = self.stage.as_mut() else { break };
            let mut run = RunContext {
                model: &mut self.model,
                systems: &mut self.systems,
                report: &mut self.report,
                monitor: &mut *monitor,
                driver: self.driver.as_mut(),
            };
            let stepped = stage.step(&mut run);
            if matches!(stepped, Ok(true)) {
                let wanted = stage.saves(&self.model);
                return match wanted.iter().try_for_each(|path| self.save_named(path)) {
                    Ok(()) => Ok(true),
                    Err(error) => self.end_stage(Err(error), false).map(|()| false),
                };
            }
            self.end_stage(stepped.map(|_| ()), false)?;
            if let Some(path) = self.checkpoints.after(&self.stages[self.over - 1].name) {
                self.save_named(&path)?;
            }
        }
        Ok(false)
    }

    /// Brings the processes of the stage under way to their end, `result` being that of its last step; `is_suspended` says that it is saved,
    /// to be restarted later.
    fn end_stage(&mut self, result: Result<()>, is_suspended: bool) -> Result<()> {
        let Some(stage) = self.stage.take() else { return result };
        self.before = None;
        let (model, systems, report) = (&mut self.model, &mut self.systems, &mut self.report);
        let ended = stage.finish((result, is_suspended), model, systems, report, self.driver.as_mut());
        self.over = if ended.is_ok() { self.over + 1 } else { self.stages.len() };
        self.report.converged = ended.is_ok() && self.over == self.stages.len();
        self.measure_memory();
        ended
    }

    /// Asks the system for the most memory the process has held: a file of the system, which takes as long as a step of a small deck.
    fn measure_memory(&mut self) {
        self.report.memory = zelus_linear_algebra::memory::largest().unwrap_or_default();
    }

    /// Does `work` in the threads of this simulation: steps within it need not be handed over one by one.
    pub fn within_threads<T: Send>(&mut self, work: impl FnOnce(&mut Self) -> T + Send) -> T {
        let pool = Arc::clone(&self.pool);
        pool.run(|| work(self))
    }

    /// Does `work` with the threads of this simulation.
    fn timed<T: Send>(&mut self, work: impl FnOnce(&mut Self) -> Result<T> + Send) -> Result<T> {
        let start = Instant::now();
        let result = self.within_threads(work);
        self.report.add_seconds("total", start.elapsed().as_secs_f64());
        result
    }
}
