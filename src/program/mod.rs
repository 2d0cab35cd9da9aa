//! The program: `zelus run`, `check`, `import`, `convert`, `new`, `partition`, `fit`, `diff`, `report`, `list`, `describe`.

mod catalogue;
mod colours;
mod deformation;
mod diff;
mod example;
mod fit;
mod fit_picture;
mod html;
mod keys;
mod kratos_names;
mod log;
mod manual;
mod matching;
mod meshes;
mod partition;
mod picture;
mod problems;
mod progress;
mod quantities;
mod report;
mod results;
mod run;
mod run_arguments;
mod say;
mod schema;
mod skin;
mod starter;
mod stop;
mod stress_columns;
mod sweep;
mod table;
mod terminal;
mod topics;
mod warnings;

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand, ValueEnum};
use zelus_core::analysis::{RunOptions, Simulation};
use zelus_core::communication::{self, Ranks};
use zelus_core::diagnostics::Diagnostic;
use zelus_core::strategies::{Monitor, Silent};
use zelus_core::{Error, Result};

use problems::Problems;
use say::say;
use terminal::{Level, Terminal};

/// Multiphysics finite elements: runs Kratos contact decks unmodified.
#[derive(Debug, Parser)]
#[command(
    name = "zelus",
    version,
    about,
    after_help = "Exit codes: 0 done and converged, 1 results differ (diff), 2 bad input, 3 not converged \
    (converged steps are written), 4 system or solver failure, 5 stopped by a signal after a step and saved \
    (continue with --resume)."
)]
struct CommandLine {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run a deck: the problem of ProjectParameters.json.
    Run(run_arguments::RunArguments),
    /// Check a deck without solving it: files, settings, objects and model.
    Check {
        /// The deck, e.g. ProjectParameters.json.
        file: PathBuf,
        /// Use the defaults of this program where the deck gives none, e.g. kratos.
        #[arg(long, value_name = "PROGRAM")]
        like: Option<String>,
        /// Replace a value of the deck, e.g. solver_settings.max_iteration=20; may be given several times.
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<String>,
        /// Format of problems: text, or one JSON object with severity, code, place, fact and remedy of each.
        #[arg(long, value_enum, default_value_t = Format::Text)]
        format: Format,
    },
    /// Read a mesh of Gmsh, Abaqus, CalculiX or VTK and write it as an mdpa file; groups become sub model parts.
    Import(meshes::Import),
    /// Read a mesh and write it in the format of its new name's ending: .mdpa, .msh, .inp, .vtu; its surface as .stl.
    Convert(meshes::Convert),
    /// Write a commented deck for a mesh, to start from: parts, materials, supports and contact pairs.
    New(starter::NewArguments),
    /// Partition the mesh of a deck for several ranks, and print the share, neighbours and communication of each.
    Partition(partition::PartitionArguments),
    /// Fit the constants of a hyperelastic material to test data; writes the material and a picture of data and fit.
    Fit(fit::FitArguments),
    /// Compare two result sets by node and field; exit code 0 if they are equal, 1 if not.
    Diff(diff::DiffArguments),
    /// Write a page about a run: the deformed model, largest stresses, reactions, contact forces, warnings and convergence. With --picture
    /// write the deformed model as a PNG file instead.
    Report(html::ReportArguments),
    /// List the names that a deck may use: an overview, those of a kind, or those about a word.
    List {
        /// A kind, e.g. process or condition; a word, e.g. contact; or all.
        kind: Option<String>,
    },
    /// Print the JSON Schema of decks or of materials files, for completion and checks in editors.
    Schema {
        /// Kind of file that the schema describes.
        #[arg(value_enum, default_value_t = schema::Of::Deck)]
        of: schema::Of,
    },
    /// Print the completions of a shell, e.g. for bash: source <(zelus completions bash).
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Print the manual page: zelus manual > zelus.1.
    Manual,
    /// Describe a name: an object with its settings and source, a variable, a flag, a key of a deck, or a subject, e.g. bolt.
    Describe {
        /// The name, as a deck would write it.
        name: String,
    },
}

/// Runs the program with the arguments of the process.
pub fn main() -> ExitCode {
    let arguments = CommandLine::parse();
    let ranks = match communication::join() {
        Ok(ranks) => ranks,
        Err(error) => {
            eprintln!("{}", explain(&error, false));
            return ExitCode::from(error.exit_code());
        }
    };
    let mut ran = false;
    match execute(arguments.command, &ranks, &mut ran) {
        Ok(code) => code,
        Err(error) => {
            let _ = std::io::stdout().flush();
            if ranks.size() > 1 {
                ranks.end_after_failure(&explain(&error, ran), error.exit_code());
            }
            let _ = writeln!(std::io::stderr(), "{}", explain(&error, ran));
            ExitCode::from(error.exit_code())
        }
    }
}

/// How `check` tells problems.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    Text,
    Json,
}

/// Executes the command; `ran` says afterwards whether a step was made.
fn execute(command: Command, ranks: &Ranks, ran: &mut bool) -> Result<ExitCode> {
    match command {
        Command::Run(arguments) => run::run(&arguments, ranks, ran),
        Command::Check { file, like, set, format } => {
            let options = RunOptions { like, ranks: ranks.clone(), changes: changes(&set)?, ..RunOptions::default() };
            if format == Format::Json && ranks.is_root() {
                let mut problems = Problems::default();
                let checked = Simulation::open(&file, &options).and_then(|mut deck| deck.check(&mut problems));
                say(&format!("{:#}", problems.json(checked.as_ref().err())));
                return Ok(checked.map_or_else(|error| ExitCode::from(error.exit_code()), |()| ExitCode::SUCCESS));
            }
            let mut monitor: Box<dyn Monitor> =
                if ranks.is_root() { Box::new(Terminal::new(Level::Usual, None)) } else { Box::new(Silent) };
            let mut simulation = Simulation::open(&file, &options)?;
            simulation.check(monitor.as_mut())?;
            if !ranks.is_root() {
                return Ok(ExitCode::SUCCESS);
            }
            let report = simulation.report();
            say(&format!(
                "{}: no errors; {} nodes, {} elements, {} conditions, {} unknowns",
                file.display(),
                report.sizes.nodes,
                report.sizes.elements,
                report.sizes.conditions,
                report.sizes.unknowns
            ));
            Ok(ExitCode::SUCCESS)
        }
        Command::Import(arguments) => meshes::import(arguments).map(|()| ExitCode::SUCCESS),
        Command::Convert(arguments) => meshes::convert(&arguments).map(|()| ExitCode::SUCCESS),
        Command::New(arguments) => starter::run(&arguments).map(|()| ExitCode::SUCCESS),
        Command::Partition(arguments) => partition::run(&arguments).map(|()| ExitCode::SUCCESS),
        Command::Fit(arguments) => fit::run(&arguments).map(|()| ExitCode::SUCCESS),
        Command::Diff(arguments) => diff::run(&arguments),
        Command::Report(arguments) => html::run(&arguments).map(|()| ExitCode::SUCCESS),
        Command::Schema { of } => {
            say(&format!("{:#}", schema::schema(of)?));
            Ok(ExitCode::SUCCESS)
        }
        Command::Completions { shell } => {
            let mut text = Vec::new();
            clap_complete::generate(shell, &mut CommandLine::command(), "zelus", &mut text);
            say(String::from_utf8_lossy(&text).trim_end());
            Ok(ExitCode::SUCCESS)
        }
        Command::Manual => {
            say(manual::manual(CommandLine::command())?.trim_end());
            Ok(ExitCode::SUCCESS)
        }
        Command::List { kind } => catalogue::list(kind.as_deref()).map(|()| ExitCode::SUCCESS),
        Command::Describe { name } => catalogue::describe(&name).map(|()| ExitCode::SUCCESS),
    }
}

/// Keys and values of `--set`: a value that is no JSON is a word.
fn changes(given: &[String]) -> Result<Vec<(String, serde_json::Value)>> {
    let of = |text: &String| {
        let (key, value) = text.split_once('=').ok_or_else(|| {
            let problem = Diagnostic::error("set", format!("--set {text} has no value"));
            problem.remedy("write KEY=VALUE, e.g. --set solver_settings.max_iteration=20")
        })?;
        let value = serde_json::from_str(value).unwrap_or_else(|_| serde_json::Value::from(value));
        Ok((key.trim().to_owned(), value))
    };
    given.iter().map(of).collect()
}

fn explain(error: &Error, ran: bool) -> String {
    match error {
        Error::Input(problems) => {
            let errors = problems.iter().filter(|p| p.severity == zelus_core::diagnostics::Severity::Error).count();
            let s = if errors == 1 { "" } else { "s" };
            let done = if ran { "results of the steps before it are written" } else { "nothing was run" };
            format!("{error}\n\n{errors} error{s} in the input; {done}")
        }
        Error::NotConverged(_) => format!("error[not-converged] {error}"),
        Error::System(_) => format!("error[system] {error}"),
    }
}
