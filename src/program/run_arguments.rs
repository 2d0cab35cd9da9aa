//! The command line of `zelus run`.

use std::path::PathBuf;

/// The command line of `zelus run`.
#[derive(Debug, clap::Args)]
pub(super) struct RunArguments {
    /// The deck, e.g. ProjectParameters.json.
    pub file: PathBuf,
    /// Number of threads; by default all of the machine. Results do not depend on it.
    #[arg(long)]
    pub threads: Option<usize>,
    /// Write the report of the run (sizes, iterations, contact state, timings, warnings) to this JSON file.
    #[arg(long, conflicts_with = "sweep")]
    pub report: Option<PathBuf>,
    /// Use the defaults of this program where the deck gives none, e.g. kratos.
    #[arg(long, value_name = "PROGRAM")]
    pub like: Option<String>,
    /// Replace a value of the deck, e.g. solver_settings.max_iteration=20; may be given several times.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Write results below this folder, not beside the deck; it is created if it does not exist.
    #[arg(short, long, value_name = "FOLDER")]
    pub output: Option<PathBuf>,
    /// Parametric study: run the deck once for each row of this table (CSV). Its first row names keys as --set does, other rows give values.
    #[arg(long, value_name = "TABLE")]
    pub sweep: Option<PathBuf>,
    /// Rows of the sweep that run at the same time and share the cores; by default as many as there are cores.
    #[arg(short, long, value_name = "N", requires = "sweep")]
    pub jobs: Option<usize>,
    /// Restart from the latest saved run of the deck, bitwise identical to an uninterrupted run; from the beginning if none
    /// was saved. With --sweep, run the rows that are not done.
    #[arg(long)]
    pub resume: bool,
    /// Print warnings and errors only.
    #[arg(short, long, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Also print the solver of each system, nodes that change their state, and the time of each phase.
    #[arg(short, long, conflicts_with = "sweep")]
    pub verbose: bool,
    /// Write all lines of --verbose, with the seconds since the start, to this file as well.
    #[arg(long, value_name = "FILE", conflicts_with = "sweep")]
    pub log: Option<PathBuf>,
}
