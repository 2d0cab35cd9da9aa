//! From the file of a deck to its stages, one after another on one model.

use std::path::Path;
use std::time::Instant;

use super::deck::{open, stages};
use super::report::RunReport;
use super::stage::{Stage, Systems};
use crate::communication::fair_threads;
use crate::diagnostics::{Diagnostic, Error, Result};
use crate::model::Model;
use crate::parameters::{Node, Value};
use crate::strategies::Monitor;

/// What a caller of [`run`] chooses.
#[derive(Debug, Clone, Default)]
pub struct RunOptions {
    /// Threads; `None` takes all of the machine, as rayon sees them.
    pub threads: Option<usize>,
    /// Program whose defaults hold where the deck names nothing, e.g. `kratos`; `None` for what the deck says, else our own.
    pub like: Option<String>,
}

/// Runs a deck; the second value is the report, also of a run that failed.
pub fn run(path: &Path, options: &RunOptions, monitor: &mut dyn Monitor) -> (Result<()>, RunReport) {
    with_threads(options, |report| {
        let (deck, folder) = open(path)?;
        let mut model = Model::default();
        let mut systems = Systems::new();
        warn_of_checkpoints(&deck, report, monitor);
        let all = stages(&deck, report)?;
        for at in 0..all.len() {
            Stage::prepare(&all[at..], &folder, options.like.as_deref(), &mut model, &mut systems, report, monitor)?
                .run(&mut model, &mut systems, report, monitor)?;
        }
        report.converged = true;
        Ok(())
    })
}

/// Does everything that can be known without solving: reads, checks, makes every object of every stage.
pub fn check(path: &Path, options: &RunOptions, monitor: &mut dyn Monitor) -> (Result<()>, RunReport) {
    with_threads(options, |report| {
        let (deck, folder) = open(path)?;
        let mut model = Model::default();
        let mut systems = Systems::new();
        warn_of_checkpoints(&deck, report, monitor);
        let all = stages(&deck, report)?;
        for at in 0..all.len() {
            Stage::prepare(&all[at..], &folder, options.like.as_deref(), &mut model, &mut systems, report, monitor)?;
            report.stages.push(all[at].name.clone());
        }
        Ok(())
    })
}

fn with_threads(
    options: &RunOptions,
    work: impl FnOnce(&mut RunReport) -> Result<()> + Send,
) -> (Result<()>, RunReport) {
    let start = Instant::now();
    let mut report = RunReport { version: env!("CARGO_PKG_VERSION").to_owned(), ..RunReport::default() };
    let pool = match rayon::ThreadPoolBuilder::new().num_threads(options.threads.unwrap_or_else(fair_threads)).build() {
        Ok(pool) => pool,
        Err(error) => return (Err(Error::System(format!("cannot start threads: {error}"))), report),
    };
    report.threads = pool.current_num_threads();
    let result = pool.install(|| work(&mut report));
    report.add_seconds("total", start.elapsed().as_secs_f64());
    (result, report)
}

fn warn_of_checkpoints(deck: &Node, report: &mut RunReport, monitor: &mut dyn Monitor) {
    let Some(wanted) = deck.get_path("orchestrator.settings.stage_checkpoints") else { return };
    if matches!(&wanted.value, Value::Bool(false)) || wanted.as_array().is_some_and(|list| list.is_empty()) {
        return;
    }
    let warning = Diagnostic::warning("checkpoint", "checkpoints are not written")
        .at(wanted.place())
        .remedy("set \"stage_checkpoints\" to false: all stages are run from the first");
    report.warnings.push(warning.to_string());
    monitor.warn(&warning);
}
