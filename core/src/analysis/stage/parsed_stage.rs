//! First phase of a stage's preparation: its deck is parsed and its settings are checked, before any mesh is read.

use super::super::deck::{StageDeck, check_top_level, root_name};
use super::super::older_decks::modernise;
use super::super::program_defaults::{apply_program_defaults, program};
use super::super::report::RunReport;
use super::super::solver::SolverSettings;
use super::super::time_stepping::TimeStepping;
use super::super::unused_settings::{check_tolerances, warn_of_unused_settings};
use super::problems_of_ranks::as_error;
use super::request::StageRequest;
use super::schedule::Schedule;
use crate::diagnostics::{Diagnostic, Report, Result};
use crate::parameters::Node;
use crate::strategies::Monitor;

/// Sections of a deck.
const SECTIONS: [&str; 6] =
    ["problem_data", "solver_settings", "processes", "output_processes", "modelers", "analysis_stage"];

/// A stage as its deck states it. Fields are `None` where `problems` hold the error that took them.
pub(super) struct ParsedStage<'a> {
    /// The stage as it stands in the deck.
    pub stage: &'a StageDeck,
    /// The stages of the deck after it.
    pub later: &'a [StageDeck],
    /// Its settings in today's spelling, with the defaults of the program that the run is like.
    pub deck: Node,
    /// Settings of the solver.
    pub solver: SolverSettings,
    /// Name of the root part; empty where the settings name none.
    pub root: String,
    /// Dimensions of the problem.
    pub domain_size: Option<usize>,
    /// Its steps in time.
    pub schedule: Option<Schedule>,
    /// Problems found so far.
    pub problems: Report,
}

impl<'a> ParsedStage<'a> {
    /// Parses the first stage of the request.
    ///
    /// # Errors
    /// A deck that is no object or has no solver; all other problems are gathered.
    pub fn parse(request: &StageRequest<'a>, report: &mut RunReport, monitor: &mut dyn Monitor) -> Result<Self> {
        let (stage, later) = request.stages.split_first().expect("there is a stage to prepare");
        let mut problems = Report::new();
        let deck = present_deck(stage, request.like, report, monitor, &mut problems);
        check_top_level(&deck, &SECTIONS, &mut problems)?;
        let times = times_of(&deck, &mut problems);
        deck.get("solver_settings").into_iter().for_each(|solver| check_tolerances(solver, &mut problems));
        let user = problems.absorb(deck.require("solver_settings").cloned());
        let solver = user.and_then(|user| {
            let solver = SolverSettings::new(&user, &mut problems);
            problems.absorb(solver)
        });
        let Some(solver) = solver else { return Err(as_error(problems)) };
        let mut of_solver = Report::new();
        let stepping = solver.settings.get("time_stepping");
        let stepping = stepping.and_then(|node| TimeStepping::from_node(node, &mut of_solver));
        let stepping = of_solver.absorb(stepping);
        let stepping = stepping.map(|own| if solver.takes_long_step() { own } else { own.without_long_step() });
        let cutting = of_solver.absorb(solver.cutting());
        let domain_size = of_solver.absorb(solver.domain_size());
        of_solver.absorb(solver.scheme().map(|_| ()));
        of_solver.absorb(solver.criterion(&mut Report::new()).map(|_| ()));
        of_solver.absorb(solver.check_names());
        let root = of_solver.absorb(root_name(&solver.settings)).unwrap_or_default();
        warn_of_unused_settings(&deck, times.zip(stepping.as_ref()), &mut problems);
        // Where settings are unsuitable, consequences of their defaults are no mistake of the deck.
        if solver.is_sound {
            of_solver.diagnostics().iter().for_each(|problem| problems.push(problem.clone()));
        }
        let schedule = times.zip(stepping).zip(cutting);
        let schedule = schedule.map(|(((start_time, end_time), stepping), cutting)| Schedule {
            start_time,
            end_time,
            stepping,
            cutting,
        });
        Ok(Self { stage, later, deck, solver, root, domain_size, schedule, problems })
    }
}

/// The settings of a stage in today's spelling, with the defaults of the program that the run is like.
fn present_deck(
    stage: &StageDeck,
    like: Option<&str>,
    report: &mut RunReport,
    monitor: &mut dyn Monitor,
    problems: &mut Report,
) -> Node {
    let mut deck = modernise(&stage.settings, problems);
    if let Some(program) = problems.absorb(program(&deck, like)).flatten() {
        let applied = apply_program_defaults(&mut deck, program, problems);
        let applied = problems.absorb(applied).unwrap_or_default();
        monitor.note(&format!(
            "defaults of {program} are used where the deck gives none: {} settings, listed in the report",
            applied.len()
        ));
        report.like = Some(program.to_owned());
        report.defaults_from_kratos.extend(applied);
    }
    deck
}

/// Start and end, from `problem_data`.
fn times_of(deck: &Node, problems: &mut Report) -> Option<(f64, f64)> {
    let data = problems.absorb(deck.require("problem_data").cloned())?;
    let start = problems.absorb(data.require("start_time").and_then(Node::f64));
    let end = problems.absorb(data.require("end_time").and_then(Node::f64));
    if let Some(parallel) = data.get("parallel_type") {
        let word = problems.absorb(parallel.str());
        if word.is_some_and(|word| !matches!(word, "OpenMP" | "MPI" | "serial")) {
            let fact = format!("\"parallel_type\" is {:?}", word.unwrap_or_default());
            let problem = Diagnostic::error("parallel-type", fact).at(parallel.place());
            problems.push(problem.remedy("use \"OpenMP\" or \"MPI\""));
        }
    }
    if let Some(minutes) = data.get("autosave_minutes")
        && let Some(number) = problems.absorb(minutes.f64())
        && number < 0.0
    {
        let fact = format!("\"autosave_minutes\" is {number}, it must be 0 or more");
        let problem = Diagnostic::error("out-of-range", fact).at(minutes.place());
        problems.push(problem.remedy("write the minutes of the clock after which the run saves itself, 0 for never"));
    }
    let (start, end) = start.zip(end)?;
    if end <= start {
        let fact = format!("\"end_time\" {end} is not after \"start_time\" {start}: there is no step to make");
        let remedy = "write an \"end_time\" after \"start_time\"";
        problems.push(Diagnostic::error("no-steps", fact).at(data.key_place("end_time")).remedy(remedy));
    }
    Some((start, end))
}
