//! Fourth phase of a stage's preparation: processes, system and strategy are made.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use zelus_linear_algebra::memory;

use super::super::contents::Contents;
use super::super::deck::{Folders, make_processes};
use super::super::report::Sizes;
use super::super::sharing::read_the_same_files;
use super::super::solver::SolverSettings;
use super::super::unused_settings::warn_of_extensions;
use super::messages::messages_of;
use super::parsed_stage::ParsedStage;
use super::problems_of_ranks::{as_error, problems_of_all, problems_of_ranks};
use super::run_context::RunContext;
use super::schedule::Schedule;
use super::shared_stage::SharedStage;
use crate::assembly::System;
use crate::communication::Ranks;
use crate::diagnostics::{Diagnostic, Report, Result, counted};
use crate::entities::Interaction;
use crate::io::{FileUse, Mark, check_files};
use crate::model::{Model, ModelPart};
use crate::parameters::{Interval, Node};
use crate::partition::{Surface, pairings, warnings_of_repeated_pairs};
use crate::processes::{Process, TimeTable, time_tables_of};
use crate::strategies::{Monitor, SolutionStrategy, unknowns_of_all};

/// Bytes that a node takes in a picture at least: its displacement, compressed.
const LEAST_OF_NODE: usize = 16;

/// A stage with everything that computes and writes.
pub(super) struct BuiltStage {
    /// Its name among the stages.
    pub name: String,
    /// Name of the root part.
    pub root: String,
    /// Its steps in time.
    pub schedule: Schedule,
    /// Settings of the solver.
    pub solver: SolverSettings,
    /// Blocks, interactions and unknowns.
    pub system: System,
    /// The solution strategy.
    pub strategy: Box<dyn SolutionStrategy>,
    /// Surfaces that processes of the deck couple, pair by pair.
    pub surfaces: Vec<Surface>,
    /// Tables over time that its processes read.
    pub tables: Vec<TimeTable>,
    /// Processes in the order in which they act.
    pub processes: Vec<Box<dyn Process>>,
    /// Files that it reads and writes.
    pub files: Vec<FileUse>,
    /// Digests of those it reads that decide results, beside deck and mesh.
    pub contents: Contents,
    /// Notes and warnings found so far.
    pub warnings: Report,
}

impl BuiltStage {
    /// Makes processes, system and strategy; processes of `more` act after those of the deck, and the caller writes `outputs`.
    /// Collective.
    ///
    /// # Errors
    /// Every problem found up to now, and those of processes, blocks, interactions and strategy, gathered.
    pub fn build(
        shared: SharedStage<'_>,
        folders: &Folders,
        more: Vec<Box<dyn Process>>,
        outputs: &[PathBuf],
        run: &mut RunContext<'_>,
    ) -> Result<Self> {
        let SharedStage { parsed, is_whole, inputs, mut contents } = shared;
        let ParsedStage { stage, deck, solver, root, schedule, mut problems, .. } = parsed;
        let ranks = run.model.ranks.clone();
        let mut processes = make_processes(&deck, folders, run.model, run.driver, &mut problems);
        processes.extend(more);
        // Problems that several ranks have in common are told once.
        problems = problems_of_all(&ranks, problems)?;
        let Some(schedule) = schedule.filter(|_| is_whole) else { return Err(as_error(problems)) };
        let mut system = run.systems.remove(&root).unwrap_or_default();
        add_interactions(&mut system, &mut processes, &root, run.model, &mut problems);
        problems = problems_of_ranks(&ranks, problems)?;
        let part = run.model.root_mut(&root)?;
        problems = initialize(&mut system, part, deck.require("solver_settings")?, problems)?;
        messages_of(&mut processes, &mut system).into_iter().for_each(|message| problems.push(message));
        let mut files: Vec<FileUse> = processes.iter().flat_map(|process| process.files()).collect();
        read_the_same_files(&ranks, &files)?;
        contents.extend(processes.iter().flat_map(|process| process.decisive_files()));
        let contents = Contents::of(&contents, &folders.deck);
        files.extend(inputs);
        run.report.inputs = files.iter().filter_map(FileUse::input).map(Path::to_owned).collect();
        files.extend(outputs.iter().cloned().map(|path| FileUse::Writes(path, Mark::None)));
        problems = check_files_of(&files, part.nodes.len(), &ranks, problems)?;
        run.report.parameters = tell_parameters(part, &system, run.monitor);
        let (strategy, says) = solver.strategy(part, &mut system, &mut problems)?;
        memory::give_back();
        run.monitor.note(&says);
        run.report.linear_solver = says;
        run.report.sizes = sizes_of(part, &system);
        let pairings = pairings(&deck, part);
        warnings_of_repeated_pairs(&pairings).into_iter().for_each(|warning| problems.push(warning));
        let surfaces = pairings.into_iter().flat_map(|pairing| pairing.surfaces).collect();
        let (name, warnings) = (stage.name.clone(), problems);
        let mut tables: Vec<TimeTable> = processes.iter().flat_map(|process| process.time_tables()).collect();
        deck.get("processes").into_iter().for_each(|lists| time_tables_of(lists, Interval::ALWAYS, &mut tables));
        Ok(Self {
            name,
            root,
            schedule,
            solver,
            system,
            strategy,
            surfaces,
            tables,
            processes,
            files,
            contents,
            warnings,
        })
    }
}

/// Initializes the processes; their interactions join the system.
fn add_interactions(
    system: &mut System,
    processes: &mut [Box<dyn Process>],
    root: &str,
    model: &mut Model,
    problems: &mut Report,
) {
    for process in processes {
        let initialized = process.initialize(model).and_then(|()| process.interaction(model));
        let Some((of, interaction)) = problems.absorb(initialized).flatten() else { continue };
        match of.split('.').next() == Some(root) {
            true => system.interactions.push(interaction),
            false => problems.push(other_root(interaction.as_ref(), &of, root)),
        }
    }
}

/// The problem that something acts on another part than the one that is solved for.
fn other_root(interaction: &dyn Interaction, of: &str, root: &str) -> Diagnostic {
    let fact = format!("{} acts on {of}, the solver of the stage on {root}", interaction.name());
    Diagnostic::error("other-model-part", fact).remedy("name parts of the solver's \"model_part_name\"")
}

/// Makes the blocks and initializes the interactions. Collective.
fn initialize(
    system: &mut System,
    part: &mut ModelPart,
    solver_settings: &Node,
    mut problems: Report,
) -> Result<Report> {
    problems.absorb(system.make_blocks(part));
    problems = problems_of_ranks(&part.ranks, problems)?;
    if !problems.has_errors() {
        warn_of_unreferenced_nodes(part, system, &mut problems);
        warn_of_extensions(solver_settings, system, &mut problems);
    }
    part.interface_surfaces.clear();
    for interaction in &mut system.interactions {
        problems.absorb(interaction.initialize(part));
    }
    Ok(problems)
}

/// The warning that nodes belong to nothing; collective.
fn warn_of_unreferenced_nodes(part: &ModelPart, system: &System, problems: &mut Report) {
    let mut used = vec![0.0; part.nodes.len()];
    for blocks in [&system.elements, &system.conditions] {
        for block in blocks {
            (0..block.len()).for_each(|at| block.nodes(at).iter().for_each(|&n| used[n as usize] = 1.0));
        }
    }
    if let Some(share) = &part.share {
        share.halo.sum(&mut used);
    }
    let unreferenced =
        (0..used.len()).filter(|&n| used[n] == 0.0 && part.owns_node(n)).map(|n| part.nodes.ids[n] as f64);
    let mut unreferenced = part.ranks.gather_numbers(&unreferenced.collect::<Vec<f64>>()).concat();
    unreferenced.sort_by(f64::total_cmp);
    if let Some(first) = unreferenced.first() {
        problems.push(
            Diagnostic::warning(
                "unreferenced-node",
                format!(
                    "{} to no element, the first is node {first}",
                    counted(unreferenced.len(), "node belongs", "nodes belong")
                ),
            )
            .remedy("they are left where they are; remove them from the mesh if that is not meant"),
        );
    }
}

/// Checks that the files can be read and written, for results of so many nodes; collective.
///
/// # Errors
/// All problems of all ranks, when one is an error.
fn check_files_of(files: &[FileUse], nodes: usize, ranks: &Ranks, mut problems: Report) -> Result<Report> {
    if ranks.is_root() {
        check_files(files, LEAST_OF_NODE * nodes).into_iter().for_each(|problem| problems.push(problem));
    }
    problems_of_all(ranks, problems)
}

/// Logs the numbers that the interactions chose for the run, and gives them.
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

/// Sizes of the problem over all ranks; collective.
fn sizes_of(part: &ModelPart, system: &System) -> Sizes {
    let sizes = part.sizes();
    Sizes {
        nodes: sizes.nodes,
        elements: sizes.elements,
        conditions: sizes.conditions,
        constraints: part.constraints.len(),
        unknowns: unknowns_of_all(part, system),
    }
}
