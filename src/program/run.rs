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
use super::say::say;
use super::stop::Stop;
use super::terminal::{Level, Terminal};
use super::{changes, explain, sweep};

/// The command line of `zelus run`.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The deck, e.g. ProjectParameters.json.
    pub file: PathBuf,
    /// Threads; all of the machine when not given. Results do not depend on it.
    #[arg(long)]
    pub threads: Option<usize>,
    /// Write the report of the run (sizes, iterations, contact state, timings, warnings) to this JSON file.
    #[arg(long, conflicts_with = "sweep")]
    report: Option<PathBuf>,
    /// Take the defaults of this program where the deck names nothing, e.g. kratos.
    #[arg(long, value_name = "PROGRAM")]
    pub like: Option<String>,
    /// Take a value in place of the deck's, e.g. solver_settings.max_iteration=20; may be given several times.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Write results below this folder, not beside the deck; it is made where it is not there.
    #[arg(short, long, value_name = "FOLDER")]
    pub output: Option<PathBuf>,
    /// Run the deck once for each row of this table (CSV): its first row names keys as --set does, each other gives their values.
    #[arg(long, value_name = "TABLE")]
    pub sweep: Option<PathBuf>,
    /// Rows of the sweep that run at a time, which share the cores; as many as there are cores when not given.
    #[arg(short, long, value_name = "N", requires = "sweep")]
    pub jobs: Option<usize>,
    /// Go on from the latest saved run of the deck, with the bits of a run that was not stopped; from the start where
    /// none was saved. Of a sweep, make the rows that are not done.
    #[arg(long)]
    pub resume: bool,
    /// Say nothing but warnings and errors.
    #[arg(short, long, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Also say who solved how, which nodes changed their state, and where the time went.
    #[arg(short, long, conflicts_with = "sweep")]
    verbose: bool,
    /// Write all that --verbose says, with the seconds since the start, to this file as well.
    #[arg(long, value_name = "FILE", conflicts_with = "sweep")]
    log: Option<PathBuf>,
}

/// Runs; `ran` says afterwards whether a step was made.
///
/// # Errors
/// What the deck, the system or a step that does not converge ends the run with.
pub(super) fn run(arguments: &Arguments, ranks: &Ranks, ran: &mut bool) -> Result<ExitCode> {
    let Arguments { file, threads, like, set, resume, quiet, verbose, .. } = arguments;
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
    let stop = Stop::listen()?;
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
        return drive(&mut simulation, &mut Silent, *resume, &stop).map(|ended| ended.code());
    }
    let level = match (quiet, verbose) {
        (true, _) => Level::Quiet,
        (_, true) => Level::Verbose,
        _ => Level::Usual,
    };
    let log = arguments.log.as_ref().map(|log| Log::begin(log, file)).transpose()?;
    let mut terminal = Terminal::new(level, log);
    let (result, mut run) = match Simulation::open(file, &options) {
        Ok(mut simulation) => (drive(&mut simulation, &mut terminal, *resume, &stop), simulation.into_report()),
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
    if let Ended::Stopped { saved, time } = &ended {
        let saved = saved.display();
        let again = words(arguments);
        say(&format!("stopped at time {time}, and saved in {saved}: `zelus run {again} --resume` goes on"));
    }
    Ok(ended.code())
}

/// The deck and what of the command line changes its results or their place.
fn words(arguments: &Arguments) -> String {
    let mut words = vec![arguments.file.display().to_string()];
    words.extend(arguments.like.iter().map(|like| format!("--like {like}")));
    words.extend(arguments.set.iter().map(|change| format!("--set '{change}'")));
    words.extend(arguments.output.iter().map(|folder| format!("--output {}", folder.display())));
    words.join(" ")
}

/// A program in Python is no deck: says what runs it.
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
enum Ended {
    Done,
    Stopped { saved: PathBuf, time: f64 },
}

impl Ended {
    fn exit_code(&self) -> u8 {
        if matches!(self, Self::Done) { 0 } else { 5 }
    }

    fn code(&self) -> ExitCode {
        ExitCode::from(self.exit_code())
    }
}

/// Makes the steps of a deck, until a signal asks to stop after the one under way.
fn drive(simulation: &mut Simulation, monitor: &mut dyn Monitor, resume: bool, stop: &Stop) -> Result<Ended> {
    if resume {
        match simulation.resume(monitor)? {
            Some(saved) => monitor.note(&format!("goes on from {}", saved.display())),
            None => monitor.note("no run of this deck was saved: it is run from its start"),
        }
    }
    while simulation.step(monitor)? {
        if simulation.model().ranks.any(stop.is_asked()) {
            let time = simulation.time().unwrap_or_default();
            return Ok(Ended::Stopped { saved: simulation.suspend()?, time });
        }
    }
    Ok(Ended::Done)
}
