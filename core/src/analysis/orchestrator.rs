//! From the file of a deck to its stages, one after another on one model.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::report::RunReport;
use super::stage::Stage;
use crate::communication::fair_threads;
use crate::diagnostics::{Diagnostic, Error, Result, did_you_mean};
use crate::model::Model;
use crate::parameters::{Document, Node};
use crate::strategies::Monitor;

/// What a caller of [`run`] chooses.
#[derive(Debug, Clone, Default)]
pub struct RunOptions {
    /// Threads; `None` takes all of the machine, as rayon sees them.
    pub threads: Option<usize>,
}

/// Runs a deck; the second value is the report, also of a run that failed.
pub fn run(path: &Path, options: &RunOptions, monitor: &mut dyn Monitor) -> (Result<()>, RunReport) {
    with_threads(options, |report| {
        let (deck, folder) = open(path)?;
        let mut model = Model::default();
        for (name, stage) in stages(&deck, report)? {
            let stage = Stage::prepare(&name, &stage, &folder, &mut model, report, monitor)?;
            stage.run(&mut model, report, monitor)?;
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
        for (name, stage) in stages(&deck, report)? {
            Stage::prepare(&name, &stage, &folder, &mut model, report, monitor)?;
            report.stages.push(name);
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

/// The parsed deck and its folder.
pub(super) fn open(path: &Path) -> Result<(Node, PathBuf)> {
    let document = Document::read(path)?;
    let folder = path.parent().map(Path::to_owned).unwrap_or_default();
    Ok((document.root.clone(), folder))
}

/// Name and deck of each stage in order.
pub(super) fn stages(deck: &Node, report: &mut RunReport) -> Result<Vec<(String, Node)>> {
    let name_of = |deck: &Node| deck.get_path("problem_data.problem_name").and_then(|n| n.as_str().map(str::to_owned));
    if deck.get("orchestrator").is_none() {
        let name = name_of(deck).unwrap_or_default();
        report.problem.clone_from(&name);
        return Ok(vec![(name, deck.clone())]);
    }
    let all = deck.require("stages")?.object()?;
    let order: Vec<String> = match deck.get_path("orchestrator.settings.execution_list") {
        Some(list) => list.array()?.iter().map(|n| n.str().map(str::to_owned)).collect::<Result<_>>()?,
        None => all.keys().map(str::to_owned).collect(),
    };
    let mut out = Vec::new();
    for name in order {
        let stage = all.get(&name).ok_or_else(|| {
            let hint = did_you_mean(&name, all.keys()).unwrap_or_else(|| "stages are the members of \"stages\"".into());
            Error::from(
                Diagnostic::error("unknown-stage", format!("there is no stage {name:?}")).at(deck.place()).remedy(hint),
            )
        })?;
        let settings = stage.require("stage_settings")?.clone();
        report.problem = name_of(&settings).unwrap_or_default();
        out.push((name, settings));
    }
    Ok(out)
}
