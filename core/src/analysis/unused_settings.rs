//! Warnings of settings without effect: keys that nothing reads, processes that never act, settings without a user.

use super::deck::{listed, unread_key};
use super::solver::SolverExtensionEntry;
use super::time_stepping::TimeStepping;
use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Report};
use crate::io::MeshFormatEntry;
use crate::parameters::{Defaults, Interval, Node};
use crate::processes::ProcessEntry;
use crate::registry;
use crate::strategies::{LinearSolverEntry, StrategyEntry};

/// Objects of a deck that no registered settings check, by the end of their path, with the keys that are read there, or that need no
/// word.
const OBJECTS: [(&str, &[&str]); 5] = [
    (
        "problem_data",
        &[
            "problem_name",
            "parallel_type",
            "autosave_minutes",
            "echo_level",
            "start_time",
            "end_time",
            "like",
            "time_step",
            "domain_size",
            "model_part_name",
            "solver_type",
        ],
    ),
    (
        "model_import_settings",
        &[
            "input_type",
            "input_filename",
            "input_file_label",
            "name",
            "skip_timer",
            "partition_in_memory",
            "ignore_variables_not_in_solution_step_data",
            "reorder",
            "reorder_consecutive",
            "perform_partitioning",
        ],
    ),
    (
        "linear_solver_settings",
        &[
            "solver_type",
            "tolerance",
            "max_iteration",
            "scaling",
            "verbosity",
            "preconditioner_type",
            "smoother_type",
            "krylov_type",
            "gmres_krylov_space_dimension",
            "coarsening_type",
            "coarse_enough",
            "block_size",
            "use_block_matrices_if_possible",
            "max_levels",
            "provide_coordinates",
            "pre_sweeps",
            "post_sweeps",
            "max_neighbours",
            "reform_preconditioner_at_each_step",
            "linear_solver_settings",
            "inner_solver_settings",
            "direct_below",
            "memory_limit",
            "petsc_engine",
            "petsc_options",
        ],
    ),
    ("solving_strategy_settings.advanced_settings", &[]),
    ("builder_and_solver_settings.advanced_settings", &[]),
];

/// Path of the steps of a stage; objects of that name further below are not read.
const STEPS: &str = "solver_settings.time_stepping";

/// Keys of a listed process beside its parameters; others that begin with an underscore or "comment" are words to readers.
const OF_PROCESS: [&str; 9] = [
    "python_module",
    "kratos_module",
    "process_name",
    "Parameters",
    "help",
    "check",
    "name",
    "implemented_in_file",
    "implemented_in_module",
];

/// Relative difference of two times that are one.
const SAME_TIME: f64 = 1e-9;

/// Keys that nothing reads, and intervals outside the times of the run.
pub(super) fn warn_of_unused_settings(deck: &Node, times: Option<((f64, f64), &TimeStepping)>, report: &mut Report) {
    warn_of_objects(deck, "", deck.get_path(STEPS), report);
    let processes = listed(deck, &mut Report::new());
    processes.iter().for_each(|process| warn_of_keys(process, "a process", &OF_PROCESS, report));
    let Some(((start, end), stepping)) = times.filter(|((start, end), _)| end > start) else { return };
    let steps = stepping.times(start, end);
    for process in &processes {
        let Some(node) = process.get_path("Parameters.interval") else { continue };
        let Ok(interval) = Interval::from_node(node) else { continue };
        // Contact and ties have nothing to do before the first step; values and output may be given at the start.
        let first = usize::from(is_of_surfaces(process));
        let Interval { begin, end: last } = interval;
        let problem = if last < begin {
            let fact = format!("the interval {node} ends before it begins: the process never acts");
            Diagnostic::warning("interval-reversed", fact).remedy("write the earlier time first")
        } else if begin > end || last < start {
            let fact = format!("the interval {node} is outside of the run, {start} to {end}: the process never acts");
            Diagnostic::note("interval-outside", fact)
                .remedy("nothing to do where a run is shorter than its deck is for")
        } else if let Some(steps) = &steps
            && !steps[first.min(steps.len())..].iter().any(|time| interval.contains(*time))
        {
            let fact = format!("no step of the run ends in the interval {node}: the process never acts");
            Diagnostic::warning("interval-outside", fact).remedy("shorten the steps, or widen the interval")
        } else if let Some(end) = steps.as_ref().and_then(|steps| steps.last())
            && (end - last).abs() <= SAME_TIME * last.abs()
            && !interval.contains(*end)
        {
            let fact = format!(
                "the interval {node} begins at 0, so that its end is outside of it: the process leaves out the last step, which ends at {end}"
            );
            Diagnostic::warning("interval-end", fact).remedy("write \"End\"")
        } else {
            continue;
        };
        report.push(problem.at(node.place()));
    }
}

/// Keys that nothing reads of the objects below `node`, which stands at `path`, that no registered settings check; `steps` are those of
/// the stage.
fn warn_of_objects(node: &Node, path: &str, steps: Option<&Node>, report: &mut Report) {
    node.as_array().into_iter().flatten().for_each(|item| warn_of_objects(item, path, steps, report));
    for member in node.as_object().into_iter().flat_map(|object| object.iter()) {
        let (object, path) = (&member.node, [path, &member.key].join("."));
        let ends_with = |name: &str| path.strip_suffix(name).is_some_and(|rest| rest.ends_with('.'));
        let name = path.trim_start_matches('.');
        if let Some((_, known)) = OBJECTS.iter().find(|(name, _)| ends_with(name))
            && let Some(own) = own_settings(object, node)
        {
            let own = own.entries().iter().map(|entry| entry.path.as_str());
            warn_of_keys(object, name, &known.iter().copied().chain(own).collect::<Vec<_>>(), report);
        }
        let is_nested = name != STEPS && ends_with("time_stepping");
        if is_nested && steps.is_some_and(|steps| steps.to_json() != object.to_json()) {
            let fact = format!("nothing reads \"{name}\", and \"{STEPS}\" of the stage differs from it");
            let remedy = "give the steps to the solver that leads, or remove the others";
            report.push(Diagnostic::warning("time-step", fact).at(node.key_place(&member.key)).remedy(remedy));
        }
        warn_of_objects(object, &path, steps, report);
    }
}

/// Whether a process of the deck makes surfaces act on each other.
fn is_of_surfaces(process: &Node) -> bool {
    let name = process.get("python_module").and_then(Node::as_str).unwrap_or_default();
    let entry = registry::find::<ProcessEntry>(name.rsplit('.').next().unwrap_or_default());
    entry.is_some_and(|entry| !(entry.surfaces)(process.get("Parameters")).is_empty())
}

/// Settings that the linear solver or mesh format named by `object`, or the strategy named by its `parent`, reads besides, empty where
/// none is named; `None` where there is no such solver, and where the strategy checks them itself.
fn own_settings(object: &Node, parent: &Node) -> Option<Defaults> {
    let name = object.get("solver_type").and_then(|node| node.as_str()?.rsplit('.').next()).unwrap_or_default();
    let format = object.get("input_type").and_then(Node::as_str).and_then(registry::find::<MeshFormatEntry>);
    let strategy = parent.get("type").and_then(Node::as_str).and_then(registry::find::<StrategyEntry>);
    match registry::find::<LinearSolverEntry>(name) {
        None if !name.is_empty() => None,
        Some(entry) if !entry.defaults.is_empty() => Defaults::parse(name, entry.defaults).ok(),
        _ if format.is_some_and(|format| !format.defaults.is_empty()) => Defaults::parse(name, format?.defaults).ok(),
        _ if strategy.is_some_and(|strategy| !strategy.defaults.is_empty()) => None,
        _ => Some(Defaults::free_form(name)),
    }
}

fn warn_of_keys(object: &Node, name: &str, known: &[&str], report: &mut Report) {
    let own = object.as_object().into_iter().flat_map(|object| object.iter());
    for member in own.filter(|member| !known.contains(&member.key.as_str()) && !is_remark(&member.key)) {
        let fact = format!("nothing reads {:?} of {name}", member.key);
        report.push(unread_key(object, &member.key, fact, known));
    }
}

fn is_remark(key: &str) -> bool {
    key.starts_with('_') || key.to_ascii_lowercase().starts_with("comment")
}

/// Tolerances that nothing could meet, or that everything meets.
pub(super) fn check_tolerances(solver: &Node, report: &mut Report) {
    for member in solver.as_object().into_iter().flat_map(|object| object.iter()) {
        check_tolerances(&member.node, report);
        let (key, Some(value)) = (&member.key, member.node.as_f64()) else { continue };
        let (is_relative, is_linear) = (key.ends_with("relative_tolerance"), key == "tolerance");
        if !key.ends_with("_tolerance") && !is_linear {
            continue;
        }
        let (make, why): (fn(&'static str, String) -> Diagnostic, _) = match value {
            _ if value < 0.0 => (Diagnostic::error, "nothing is below it"),
            _ if value >= 1.0 && is_relative => (Diagnostic::error, "every first iterate meets it"),
            _ if value >= 1.0 && is_linear => (Diagnostic::error, "no solve would begin"),
            _ if value == 0.0 && is_relative => (Diagnostic::warning, "steps iterate until only round-off is left"),
            _ => continue,
        };
        let problem = make("invalid-tolerance", format!("{key:?} is {value}: {why}")).at(solver.key_place(key));
        report.push(problem.remedy("write a number between 0 and 1, e.g. 1e-4"));
    }
}

/// Settings of an application in the solver that nothing makes use of, since no process has brought an interaction.
pub(super) fn warn_of_extensions(solver: &Node, system: &System, report: &mut Report) {
    if !system.interactions.is_empty() {
        return;
    }
    for entry in registry::all::<SolverExtensionEntry>().into_iter().filter(|entry| !entry.build.acts_alone) {
        if solver.get(entry.name).is_some_and(Node::is_given) {
            let fact = format!("{:?} is given, and no process of the deck makes use of it", entry.name);
            let remedy = "list the process that makes bodies act on each other, or remove the settings";
            let problem = Diagnostic::warning("settings-without-process", fact).at(solver.key_place(entry.name));
            report.push(problem.remedy(remedy));
        }
    }
}
