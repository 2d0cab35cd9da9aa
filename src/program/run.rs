//! `zelus run`: one run of a deck, or one for each row of a table.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use zelus_core::Result;
use zelus_core::analysis::{RunOptions, RunReport, Simulation};
use zelus_core::communication::Ranks;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::strategies::{Monitor, Silent};

use super::log::Log;
use super::report::{Report, made_folder};
use super::run_arguments::RunArguments;
use super::say::say;
use super::stop::Stop;
use super::terminal::{Level, Terminal};
use super::{changes, explain, sweep};

/// Runs; `ran` says afterwards whether a step was made.
///
/// # Errors
/// Faults of the deck or the system, and a step that does not converge.
pub(super) fn run(arguments: &RunArguments, ranks: &Ranks, ran: &mut bool) -> Result<ExitCode> {
    let RunArguments { file, threads, like, set, resume, quiet, verbose, .. } = arguments;
    refuse_script(file)?;
    if let Some(table) = &arguments.sweep {
        return sweep::run(arguments, table, ranks);
    }
    if let Some(folder) = &arguments.output {
        made_folder(folder)?;
    }
    let report = arguments.report.clone().map(Report);
    if let Some(report) = &report {
        report.check(file)?;
    }
    let stop = Stop::listen(ranks.is_root())?;
    let options = RunOptions {
        threads: *threads,
        like: like.clone(),
        ranks: ranks.clone(),
        outputs: report.iter().map(|report| &report.0).chain(&arguments.log).cloned().collect(),
        changes: changes(set)?,
        results: arguments.output.clone(),
    };
    if !ranks.is_root() {
        let mut simulation = Simulation::open(file, &options)?;
        let ended = simulation.within_threads(|simulation| drive(simulation, &mut Silent, *resume, &stop));
        return ended.map(|ended| ended.code());
    }
    let level = match (quiet, verbose) {
        (true, _) => Level::Quiet,
        (_, true) => Level::Verbose,
        _ => Level::Usual,
    };
    let log = arguments.log.as_ref().map(|log| Log::begin(log, file)).transpose()?;
    let mut terminal = Terminal::new(level, log);
    let (result, mut run) = match Simulation::open(file, &options) {
        Ok(mut simulation) => {
            let ended = simulation.within_threads(|simulation| drive(simulation, &mut terminal, *resume, &stop));
            (ended, simulation.into_report())
        }
        Err(error) => (Err(error), RunReport::default()),
    };
    *ran = !run.steps.is_empty();
    match &result {
        Ok(ended) => run.exit_code = ended.exit_code(),
        Err(error) => run.fail(error),
    }
    let failed = result.as_ref().err().map(|error| explain(error, *ran));
    terminal.finish(&run, failed.as_deref());
    let written = report.map_or(Ok(()), |report| report.write(&run, result.as_ref().err()));
    let ended = result?;
    written?;
    if let RunEnd::Stopped { saved, time } = &ended {
        let saved = saved.display();
        let again = words(arguments);
        say(&format!("stopped at time {time}, and saved in {saved}: `zelus run {again} --resume` continues it"));
    }
    Ok(ended.code())
}

/// The deck and the arguments of the command line that change its results or their place.
fn words(arguments: &RunArguments) -> String {
    let mut words = vec![arguments.file.display().to_string()];
    words.extend(arguments.like.iter().map(|like| format!("--like {like}")));
    words.extend(arguments.set.iter().map(|change| format!("--set '{change}'")));
    words.extend(arguments.output.iter().map(|folder| format!("--output {}", folder.display())));
    words.join(" ")
}

/// A program in Python is no deck: names the program that runs it.
fn refuse_script(file: &Path) -> Result<()> {
    if file.extension().is_none_or(|ending| ending != "py") {
        return Ok(());
    }
    let fact = format!("{} is a program in Python", file.display());
    let remedy = format!(
        "`python -m zelus {}` runs it, with the Python package; or name the deck that it reads",
        file.display()
    );
    Err(Diagnostic::error("python-program", fact).remedy(remedy).into())
}

/// How a run came to its end.
enum RunEnd {
    Done,
    Stopped { saved: PathBuf, time: f64 },
}

impl RunEnd {
    fn exit_code(&self) -> u8 {
        if matches!(self, Self::Done) { 0 } else { 5 }
    }

    fn code(&self) -> ExitCode {
        ExitCode::from(self.exit_code())
    }
}

/// Makes the steps of a deck, until a signal asks to stop after the one under way.
fn drive(simulation: &mut Simulation, monitor: &mut dyn Monitor, resume: bool, stop: &Stop) -> Result<RunEnd> {
    if resume {
        match simulation.resume(monitor)? {
            Some(saved) => monitor.note(&format!("restart from {}", saved.display())),
            None => monitor.note("no saved run of this deck: the run starts from the beginning"),
        }
    }
    while simulation.step(monitor)? {
        if simulation.model().ranks.any(stop.is_asked()) {
            let time = simulation.time().unwrap_or_default();
            return Ok(RunEnd::Stopped { saved: simulation.suspend()?, time });
        }
        if let Some(saved) = simulation.autosave()? {
            monitor.note(&format!("saved in {}, in case the run is killed: `--resume` continues it", saved.display()));
        }
    }
    simulation.remove_autosave();
    Ok(RunEnd::Done)
}
