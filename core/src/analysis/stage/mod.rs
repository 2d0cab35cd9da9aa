//! One stage: a solver, its processes, and the loop over the steps.

mod attempts;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use zelus_linear_algebra::memory;

use super::bodies::tell_what_holds;
use super::cutting::Cutting;
use super::deck::{
    Folders, StageDeck, add_names_only, check_top_level, import, import_materials, make_processes, mesh_file, root_name,
};
use super::driver::{Driver, Point};
use super::like::{lay_defaults, program};
use super::older_decks::{complete_part_names, modernise};
use super::report::{RunReport, Sizes};
use super::saved_run::{SavedStage, hand_out, resume_blocks, states_of};
use super::sharing::{distribute, read_the_same_deck, read_the_same_files};
use super::solver::{SolverSettings, TimeScheme, check_dimensions};
use super::soundness::{prescriptions, warn_of_contradictions, warn_of_loads_given_twice, warn_of_twins};
use super::time_stepping::TimeStepping;
use super::unheeded::{check_tolerances, warn_of_extensions, warn_of_unheeded};
use crate::assembly::System;
use crate::communication::Ranks;
use crate::diagnostics::{Diagnostic, Error, Report, Result, Severity, unfit};
use crate::entities::Interaction;
use crate::io::{Claim, FileUse, Mark, MeshFormatEntry, check_files};
use crate::model::{Model, ModelPart};
use crate::modelers::run_modelers;
use crate::parameters::Node;
use crate::processes::{Process, largest_results, tables_of};
use crate::registry;
use crate::strategies::{Monitor, Plan, SolutionStrategy, unknowns_of_all};

/// Bytes that a node takes in a picture at least: its displacement, compressed.
const LEAST_OF_NODE: usize = 16;

/// The systems of earlier stages by their root parts: what elements remember goes on with them.
pub(super) type Systems = BTreeMap<String, System>;

/// A stage that is ready to run.
pub(super) struct Stage {
    name: String,
    root: String,
    system: System,
    start_time: f64,
    end_time: f64,
    stepping: TimeStepping,
    cutting: Cutting,
    /// Length to begin the next step with, where the last one had to be shortened.
    first_length: Option<f64>,
    strategy: Box<dyn SolutionStrategy>,
    processes: Vec<Box<dyn Process>>,
    files: Vec<FileUse>,
    /// The outputs that no other run may write meanwhile; `None` before the first step.
    claims: Option<Vec<Claim>>,
    begun: bool,
}

impl Stage {
    /// Reads mesh and materials, makes the processes, blocks and strategy: everything short of solving. Processes of `more` act
    /// after those of the deck.
    ///
    /// # Errors
    /// Every problem of the deck that can be found, gathered.
    pub(super) fn prepare(
        stages: &[StageDeck],
        folders: &Folders,
        like: Option<&str>,
        model: &mut Model,
        systems: &mut Systems,
        report: &mut RunReport,
        monitor: &mut dyn Monitor,
        driver: &mut dyn Driver,
        more: Vec<Box<dyn Process>>,
        outputs: &[PathBuf],
    ) -> Result<Self> {
        monitor.phase("read");
        let start = Instant::now();
        let (stage, later) = stages.split_first().expect("there is a stage to prepare");
        let mut problems = Report::new();
        let mut deck = modernise(&stage.settings, &mut problems);
        if let Some(program) = problems.absorb(program(&deck, like)).flatten() {
            let laid = lay_defaults(&mut deck, program, &mut problems);
            let laid = problems.absorb(laid).unwrap_or_default();
            monitor.note(&format!(
                "defaults of {program} hold where the deck names nothing: {} settings, which the report lists",
                laid.len()
            ));
            report.like = Some(program.to_owned());
            report.laid_defaults.extend(laid);
        }
        let known = ["problem_data", "solver_settings", "processes", "output_processes", "modelers", "analysis_stage"];
        check_top_level(&deck, &known, &mut problems)?;
        let problem_data = problems.absorb(deck.require("problem_data").cloned());
        let times = problem_data.as_ref().and_then(|data| {
            let start = problems.absorb(data.require("start_time").and_then(Node::f64));
            let end = problems.absorb(data.require("end_time").and_then(Node::f64));
            if let Some(parallel) = data.get("parallel_type") {
                let word = problems.absorb(parallel.str());
                if word.is_some_and(|word| !matches!(word, "OpenMP" | "MPI" | "serial")) {
                    let fact = format!("\"parallel_type\" is {:?}", word.unwrap_or_default());
                    problems.push(
                        Diagnostic::error("parallel-type", fact)
                            .at(parallel.place())
                            .remedy("use \"OpenMP\" or \"MPI\""),
                    );
                }
            }
            if let Some((start, end)) = start.zip(end)
                && end <= start
            {
                let fact = format!("\"end_time\" {end} is not after \"start_time\" {start}: there is no step to make");
                let remedy = "write an \"end_time\" after \"start_time\"";
                problems.push(Diagnostic::error("no-steps", fact).at(data.key_place("end_time")).remedy(remedy));
            }
            start.zip(end)
        });
        deck.get("solver_settings").into_iter().for_each(|solver| check_tolerances(solver, &mut problems));
        let user = problems.absorb(deck.require("solver_settings").cloned());
        let solver = user.and_then(|user| {
            let solver = SolverSettings::new(&user, &mut problems);
            problems.absorb(solver)
        });
        let ranks = model.ranks.clone();
        let Some(solver) = solver else { return Err(finish(problems)) };
        let mut of_solver = Report::new();
        let stepping = solver.settings.get("time_stepping");
        let stepping = stepping.and_then(|node| TimeStepping::from_node(node, &mut of_solver));
        let stepping = of_solver.absorb(stepping);
        let cutting = of_solver.absorb(solver.cutting());
        let domain_size = of_solver.absorb(solver.domain_size());
        of_solver.absorb(solver.scheme().map(|_| ()));
        of_solver.absorb(solver.criterion(&mut Report::new()).map(|_| ()));
        of_solver.absorb(solver.check_names());
        let root = of_solver.absorb(root_name(&solver.settings)).unwrap_or_default();
        warn_of_unheeded(&deck, times.zip(stepping.as_ref()), &mut problems);
        // Where settings do not fit, what follows from their defaults is no mistake of the deck.
        if solver.is_sound {
            of_solver.diagnostics().iter().for_each(|problem| problems.push(problem.clone()));
        }
        read_the_same_deck(&ranks, &deck)?;
        // What the deck begins with is read by rank 0 alone, which shares it out.
        let by_root = ranks.size() > 1 && model.parts.is_empty();
        let [mut is_read, mut is_whole] = [true; 2];
        if ranks.is_root() || !by_root {
            [is_read, is_whole] = read_model(stage, &solver, domain_size, &root, &folders.deck, model, &mut problems);
        }
        problems = problems_of_ranks(&ranks, problems)?;
        if !is_read && add_names_only(&solver, &root, &folders.deck, model).is_none() {
            return Err(finish(problems));
        }
        report.add_seconds("read", start.elapsed().as_secs_f64());
        monitor.phase("set up");
        let start = Instant::now();
        complete_part_names(&mut deck, &root, model, &mut problems);
        let mut decks = vec![deck.clone()];
        for later in later {
            let mut deck = modernise(&later.settings, &mut Report::new());
            complete_part_names(&mut deck, &root, model, &mut Report::new());
            decks.push(deck);
        }
        let changes = later.iter().any(|later| !later.modelers.is_empty());
        let (of_mesh, mut inputs) = inputs_of(stage, &deck, &folders.deck);
        read_the_same_files(&ranks, &inputs)?;
        if !by_root {
            read_the_same_files(&ranks, &of_mesh)?;
        }
        inputs.extend(of_mesh);
        if is_read {
            distribute(model, &root, &decks, changes, monitor)?;
        }
        memory::give_back();
        // Ranks that have read no mesh know its parts only now.
        complete_part_names(&mut deck, &root, model, &mut problems);
        if is_whole && !problems.has_errors() {
            driver.at(Point::Read, &root, model, &System::default(), &mut |_| Ok(()))?;
        }
        let mut processes = make_processes(&deck, folders, model, driver, &mut problems);
        processes.extend(more);
        // What several ranks say one process says alone.
        problems = problems_of_all(&ranks, problems)?;
        if !is_whole {
            return Err(finish(problems));
        }
        let mut system = systems.remove(&root).unwrap_or_default();
        for process in &mut processes {
            let initialized = process.initialize(model).and_then(|()| process.interaction(model));
            let Some((of, interaction)) = problems.absorb(initialized).flatten() else { continue };
            match of.split('.').next() == Some(&root) {
                true => system.interactions.push(interaction),
                false => problems.push(other_root(interaction.as_ref(), &of, &root)),
            }
        }
        problems = problems_of_ranks(&ranks, problems)?;
        let part = model.root_mut(&root)?;
        problems.absorb(system.make_blocks(part));
        problems = problems_of_ranks(&ranks, problems)?;
        if !problems.has_errors() {
            warn_of_lonely_nodes(part, &system, &mut problems);
            warn_of_extensions(deck.require("solver_settings")?, &system, &mut problems);
        }
        for interaction in &mut system.interactions {
            problems.absorb(interaction.initialize(part));
        }
        messages_of(&mut processes, &mut system).into_iter().for_each(|message| problems.push(message));
        let mut files: Vec<FileUse> = processes.iter().flat_map(|process| process.files()).collect();
        read_the_same_files(&ranks, &files)?;
        files.extend(inputs);
        report.inputs = files.iter().filter_map(FileUse::input).map(Path::to_owned).collect();
        files.extend(outputs.iter().cloned().map(|path| FileUse::Writes(path, Mark::None)));
        if ranks.is_root() {
            check_files(&files, LEAST_OF_NODE * part.nodes.len())
                .into_iter()
                .for_each(|problem| problems.push(problem));
        }
        problems = problems_of_all(&ranks, problems)?;
        report.parameters = tell_parameters(part, &system, monitor);
        let (strategy, says) = solver.strategy(part, &mut system, &mut problems)?;
        memory::give_back();
        monitor.note(&says);
        report.linear_solver = says;
        let sizes = part.sizes();
        report.sizes = Sizes {
            nodes: sizes.nodes,
            elements: sizes.elements,
            conditions: sizes.conditions,
            constraints: part.constraints.len(),
            unknowns: unknowns_of_all(part, &system),
        };
        for process in &processes {
            let checked = process.check(model, &system, &mut problems);
            problems.absorb(checked);
        }
        let (start_time, end_time) = times.expect("checked above");
        let part = model.root(&root)?;
        warn_of_twins(part, &mut problems);
        warn_of_loads_given_twice(part, &processes, &mut problems);
        warn_of_contradictions(part, &processes, [0.5 * (start_time + end_time), end_time], &mut problems);
        if matches!(solver.scheme()?, TimeScheme::Implicit(scheme) if scheme.is_static()) && part.info.step == 0 {
            let prescribed = prescriptions(part, &processes, 0.5 * (start_time + end_time));
            tell_what_holds(part, &system, &prescribed, &mut problems);
        }
        tell(problems_of_all(&ranks, problems)?.finish()?, report, monitor);
        driver.at(Point::Ready, &root, model, &system, &mut |_| Ok(()))?;
        report.add_seconds("set up", start.elapsed().as_secs_f64());
        Ok(Self {
            name: stage.name.clone(),
            root,
            system,
            start_time,
            end_time,
            stepping: stepping.expect("checked above"),
            cutting: cutting.expect("checked above"),
            first_length: None,
            strategy,
            processes,
            files,
            claims: None,
            begun: false,
        })
    }

    /// What it is going to do, as the first of the `left` stages of `all`.
    pub(super) fn plan(&self, left: usize, all: usize) -> Plan {
        let (start, end) = (self.start_time, self.end_time);
        Plan { stage: all - left + 1, stages: all, start, end, steps: self.stepping.count(start, end) }
    }

    /// Name of the part that it solves for.
    pub(super) fn root(&self) -> &str {
        &self.root
    }

    /// What computes on that part.
    pub(super) fn system(&self) -> &System {
        &self.system
    }

    /// Keeps other runs from writing what this one does.
    fn claim(&mut self, ranks: &Ranks) -> Result<()> {
        let outputs = self.files.iter().filter_map(FileUse::output).filter(|_| ranks.is_root());
        self.claims = Some(ranks.agree(outputs.map(Claim::of).collect())?);
        Ok(())
    }

    fn begin(&mut self, model: &mut Model, report: &mut RunReport, driver: &mut dyn Driver) -> Result<()> {
        self.begun = true;
        report.stages.push(self.name.clone());
        let processes = &mut self.processes;
        driver.at(Point::BeforeLoop, &self.root, model, &self.system, &mut |model| {
            let ranks = model.ranks.clone();
            processes.iter_mut().try_for_each(|process| ranks.agree(process.before_loop(model)))
        })?;
        model.root_mut(&self.root)?.info.time = self.start_time;
        for process in &mut self.processes {
            model.ranks.clone().agree(process.print_start(model, &self.system))?;
        }
        Ok(())
    }

    /// Where processes want the run to be saved now.
    pub(super) fn saves(&mut self, model: &Model) -> Vec<PathBuf> {
        self.processes.iter_mut().filter_map(|process| process.saves(model)).collect()
    }

    /// What it remembers between steps.
    pub(super) fn state(&self) -> SavedStage {
        SavedStage {
            begun: self.begun,
            first_length: self.first_length,
            unknowns: self.system.dofs.layout(),
            strategy: self.strategy.state(),
            elements: states_of(&self.system.elements),
            conditions: states_of(&self.system.conditions),
            interactions: self.system.interactions.iter().map(|interaction| interaction.state()).collect(),
            processes: self.processes.iter().map(|process| process.state()).collect(),
        }
    }

    /// Takes up what it remembered between steps; `model` is that of then.
    ///
    /// # Errors
    /// States of another deck; files of output that are not there any more.
    pub(super) fn resume(&mut self, model: &mut Model, state: SavedStage) -> Result<()> {
        (self.begun, self.first_length) = (state.begun, state.first_length);
        let part = model.root_mut(&self.root)?;
        let begins = !self.begun || part.info.time >= self.start_time && part.info.time.is_finite();
        if !begins || state.first_length.is_some_and(|length| !(length > 0.0 && length.is_finite())) {
            return Err(unfit("it stands at no time of the run"));
        }
        resume_blocks(&mut self.system.elements, state.elements)?;
        resume_blocks(&mut self.system.conditions, state.conditions)?;
        hand_out(&mut self.system.interactions, state.interactions, "interactions", |own, state| {
            own.resume(part, state)
        })?;
        if let Some(state) = state.strategy {
            self.strategy.resume(part, &self.system, state)?;
        }
        let ranks = model.ranks.clone();
        hand_out(&mut self.processes, state.processes, "processes", |own, state| ranks.agree(own.resume(model, state)))
    }

    /// Makes the next step of the deck, in several shorter ones where it does not converge; `false` when none is left.
    ///
    /// # Errors
    /// A step that does not converge, however short; a failed solver, process or file.
    pub(super) fn step(
        &mut self,
        model: &mut Model,
        report: &mut RunReport,
        monitor: &mut dyn Monitor,
        driver: &mut dyn Driver,
    ) -> Result<bool> {
        if self.claims.is_none() {
            self.claim(&model.ranks)?;
        }
        if !self.begun {
            self.begin(model, report, driver)?;
        }
        let part = model.root_mut(&self.root)?;
        let time = part.info.time;
        if time >= self.end_time {
            if time > self.end_time {
                let ends = format!("the last step ends at {time}, after \"end_time\" {}", self.end_time);
                monitor.note(&format!("{ends}: \"last_step\": \"shortened\" in \"time_stepping\" would end it there"));
            }
            let last = self.system.interactions.iter().flat_map(|interaction| interaction.last_messages(part));
            let last = last.chain(self.strategy.last_messages(part)).collect();
            tell(part.ranks.problems_of_all(last), report, monitor);
            return Ok(false);
        }
        let length = self.strategy.step_length(part, &self.system, self.stepping.next(time)?)?;
        let (target, is_shortened) = self.stepping.target(time, length, [self.start_time, self.end_time]);
        if is_shortened {
            monitor.note(&format!(
                "the last step is shortened from {length} to {:.6e}, to end at {target}",
                target - time
            ));
        }
        self.reach(target, model, report, monitor, driver).map(|()| true)
    }

    /// Finalises the processes, also after a step that has failed, or suspends them where the stage goes on later; what elements remember
    /// goes to `systems`.
    ///
    /// # Errors
    /// `result`, the end of the last step, or else what a process has met.
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
        let finalized = driver.at(Point::Finalize, &self.root, model, &self.system, &mut |model| {
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
        report.largest = part.map(largest_results).unwrap_or_default();
        systems.insert(self.root, System { elements: self.system.elements, ..System::default() });
        result.and(finalized).and(finals.finish().map(|_| ()))
    }

    /// Hands on what processes, interactions and the strategy have to tell; collective.
    fn pass_on_messages(&mut self, ranks: &Ranks, report: &mut RunReport, monitor: &mut dyn Monitor) {
        let mut own = self.strategy.messages();
        own.extend(messages_of(&mut self.processes, &mut self.system));
        tell(ranks.problems_of_all(own), report, monitor);
    }
}

/// Notes and warnings of processes and interactions.
fn messages_of(processes: &mut [Box<dyn Process>], system: &mut System) -> Vec<Diagnostic> {
    let of_processes = processes.iter_mut().flat_map(|process| process.messages());
    of_processes.chain(system.interactions.iter_mut().flat_map(|interaction| interaction.messages())).collect()
}

/// Hands notes and warnings to the monitor and the report.
fn tell(messages: Vec<Diagnostic>, report: &mut RunReport, monitor: &mut dyn Monitor) {
    for message in messages {
        let list = if message.severity == Severity::Note { &mut report.notes } else { &mut report.warnings };
        list.push(message.to_string());
        monitor.warn(&message);
    }
}

fn finish(mut problems: Report) -> Error {
    if !problems.has_errors() {
        problems.push(Diagnostic::error("deck", "the deck cannot be prepared"));
    }
    problems.finish().expect_err("it has errors")
}

/// The problems of all ranks, each once; collective.
///
/// # Errors
/// All of them, when one on any rank is an error.
fn problems_of_all(ranks: &Ranks, problems: Report) -> Result<Report> {
    let (Ok(own) | Err(Error::Input(own))) = problems.finish() else { unreachable!("problems are of the input") };
    let mut all = Report::new();
    ranks.problems_of_all(own).into_iter().for_each(|problem| all.push(problem));
    if all.has_errors() { Err(finish(all)) } else { Ok(all) }
}

/// The problems so far: several ranks stop at the first errors, one process goes on to find all there are. Collective.
///
/// # Errors
/// All of them, when one is an error and there are several ranks.
fn problems_of_ranks(ranks: &Ranks, problems: Report) -> Result<Report> {
    if ranks.size() > 1 { problems_of_all(ranks, problems) } else { Ok(problems) }
}

/// The problem that something acts on another part than the one that is solved for.
fn other_root(interaction: &dyn Interaction, of: &str, root: &str) -> Diagnostic {
    let fact = format!("{} acts on {of}, the solver of the stage on {root}", interaction.name());
    Diagnostic::error("other-model-part", fact).remedy("name parts of the solver's \"model_part_name\"")
}

/// Says what numbers the interactions chose for the run, and gives them.
fn tell_parameters(part: &ModelPart, system: &System, monitor: &mut dyn Monitor) -> BTreeMap<String, f64> {
    let mut all = BTreeMap::new();
    for interaction in &system.interactions {
        let chosen = interaction.parameters(part);
        if !chosen.is_empty() {
            let words: Vec<String> = chosen.iter().map(|(name, value)| format!("{name} {value:.6e}")).collect();
            monitor.note(&format!("{}: {}", interaction.name(), words.join(", ")));
        }
        all.extend(chosen.into_iter().map(|(name, value)| (name.to_owned(), value)));
    }
    all
}

/// The warning that nodes belong to nothing; collective.
fn warn_of_lonely_nodes(part: &ModelPart, system: &System, problems: &mut Report) {
    let mut used = vec![0.0; part.nodes.len()];
    for blocks in [&system.elements, &system.conditions] {
        for block in blocks {
            (0..block.len()).for_each(|at| block.nodes(at).iter().for_each(|&n| used[n as usize] = 1.0));
        }
    }
    if let Some(share) = &part.share {
        share.halo.sum(&mut used);
    }
    let lonely = (0..used.len()).filter(|&n| used[n] == 0.0 && part.owns_node(n)).map(|n| part.nodes.ids[n] as f64);
    let mut lonely = part.ranks.gather_numbers(&lonely.collect::<Vec<f64>>()).concat();
    lonely.sort_by(f64::total_cmp);
    if let Some(first) = lonely.first() {
        problems.push(
            Diagnostic::warning(
                "unreferenced-node",
                format!("{} nodes belong to no element, the first is node {first}", lonely.len()),
            )
            .remedy("they are left where they are; remove them from the mesh if that is not meant"),
        );
    }
}

/// Meshes and materials of a stage, and what modelers make of them: whether there is a mesh to go on with, and whether all is there.
fn read_model(
    stage: &StageDeck,
    solver: &SolverSettings,
    domain_size: Option<usize>,
    root: &str,
    folder: &Path,
    model: &mut Model,
    problems: &mut Report,
) -> [bool; 2] {
    let modelled = run_modelers(&stage.modelers, folder, model, problems);
    problems.absorb(modelled);
    let is_read = domain_size.is_some_and(|domain_size| {
        let imported = import(solver, root, folder, model, problems);
        let imported = imported.and_then(|()| check_dimensions(model.root(root)?, domain_size));
        problems.absorb(imported).is_some()
    });
    let materials = if is_read { import_materials(solver, root, folder, model, problems) } else { Ok(()) };
    [is_read, problems.absorb(materials).is_some() && is_read && solver.is_whole]
}

/// What a stage reads: meshes and materials; deck and tables.
fn inputs_of(stage: &StageDeck, deck: &Node, folder: &Path) -> (Vec<FileUse>, Vec<FileUse>) {
    let named = |key: &str| deck.get_path(key).and_then(Node::as_str).filter(|name| !name.is_empty());
    let mesh = deck.get("solver_settings").and_then(|solver| mesh_file(solver, folder)).map(|(_, file)| file);
    let materials = named("solver_settings.material_import_settings.materials_filename").map(|name| folder.join(name));
    let of_modeler = |modeler: &Node| {
        let parameters = modeler.get("parameters").or_else(|| modeler.get("Parameters"))?;
        let name = parameters.get("input_filename")?.as_str()?;
        registry::find::<MeshFormatEntry>("mdpa").map(|format| format.file(&folder.join(name)))
    };
    let meshes = stage.modelers.iter().filter_map(of_modeler);
    let mut others = vec![deck.place().file];
    tables_of(deck, &mut others);
    let files = mesh.into_iter().chain(materials).chain(meshes);
    (files.map(FileUse::Reads).collect(), others.into_iter().map(FileUse::Reads).collect())
}
