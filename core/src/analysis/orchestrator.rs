//! From the file of a deck to its stages, one after another on one model.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::report::RunReport;
use super::stage::Stage;
use crate::communication::fair_threads;
use crate::diagnostics::{Diagnostic, Error, Result, did_you_mean};
use crate::model::Model;
use crate::parameters::{Document, Node, Value};
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
        warn_of_checkpoints(&deck, report, monitor);
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
        warn_of_checkpoints(&deck, report, monitor);
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
    refuse_other_orchestrators(deck)?;
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
        for key in ["stage_preprocess", "stage_postprocess"] {
            refuse_work_between_stages(stage, key)?;
        }
        let settings = stage.require("stage_settings")?.clone();
        report.problem = name_of(&settings).unwrap_or_default();
        out.push((name, settings));
    }
    Ok(out)
}

/// Stages run one after another, from the first.
fn refuse_other_orchestrators(deck: &Node) -> Result<()> {
    if let Some(name) = deck.get_path("orchestrator.name")
        && !name.str()?.ends_with("SequentialOrchestrator")
    {
        let fact = format!("there is no orchestrator {:?}", name.str()?);
        let remedy = "use \"Orchestrators.KratosMultiphysics.SequentialOrchestrator\"";
        return Err(Diagnostic::error("orchestrator", fact).at(name.place()).remedy(remedy).into());
    }
    match deck.get_path("orchestrator.settings.load_from_checkpoint").filter(|from| !from.is_null()) {
        None => Ok(()),
        Some(from) => Err(Diagnostic::error("checkpoint", "checkpoints are not read")
            .at(from.place())
            .remedy("set \"load_from_checkpoint\" to null: all stages are run from the first")
            .into()),
    }
}

fn refuse_work_between_stages(stage: &Node, key: &str) -> Result<()> {
    let Some(work) = stage.get(key).and_then(Node::as_object) else { return Ok(()) };
    let is_empty = |node: &Node| match &node.value {
        Value::Array(items) => items.is_empty(),
        Value::Object(members) => members.iter().next().is_none(),
        _ => false,
    };
    match work.in_source_order().iter().find(|member| !is_empty(&member.node)) {
        None => Ok(()),
        Some(member) => Err(Diagnostic::error("stage-work", format!("\"{}\" of \"{key}\" is not run", member.key))
            .at(member.node.place())
            .remedy("put processes into the \"processes\" of a stage's settings, and take this out")
            .into()),
    }
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
