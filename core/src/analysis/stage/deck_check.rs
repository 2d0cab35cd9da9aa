//! Last phase of a stage's preparation: the stage as built is checked, before its first step.

use super::super::body_loads::{warn_of_body_loads, warn_of_no_inertia};
use super::super::coincident_nodes::warn_of_coincident_nodes;
use super::super::loose_loads::warn_of_loose_loads;
use super::super::model_checks::{
    check_constraints, prescriptions, warn_of_collapsed, warn_of_contradictions, warn_of_height,
    warn_of_loads_given_twice, warn_of_supported_loads, warn_of_twins,
};
use super::super::no_load::warn_of_no_load;
use super::super::rigid_body_modes::report_restraints;
use super::super::solver::TimeScheme;
use super::super::unresisted_loads::report_unresisted_loads;
use super::built_stage::BuiltStage;
use super::problems_of_ranks::problems_of_all;
use crate::diagnostics::{Diagnostic, Result};
use crate::model::Model;

/// Notes and warnings of the stage as built, of all ranks; and, where the restraint of bodies is looked at, whether contact alone
/// restrains some and none is free. Collective.
///
/// # Errors
/// Contradictions of processes, loads and supports, and other problems that they find, gathered.
pub(super) fn check(built: &BuiltStage, model: &Model) -> Result<(Vec<Diagnostic>, Option<bool>)> {
    let BuiltStage { root, schedule, solver, system, processes, surfaces, tables, .. } = built;
    let mut problems = built.warnings.clone();
    for process in processes {
        let checked = process.check(model, system, &mut problems);
        problems.absorb(checked);
    }
    let part = model.root(root)?;
    if part.info.step == 0 {
        let problem = schedule.stepping.problem(schedule.start_time, schedule.end_time);
        problem.into_iter().for_each(|problem| problems.push(problem));
    }
    let middle = 0.5 * (schedule.start_time + schedule.end_time);
    let early = tables.iter().filter_map(|table| table.ends_early(schedule.interval()));
    early.for_each(|problem| problems.push(problem));
    tables.iter().filter_map(|table| table.fault.clone()).for_each(|problem| problems.push(problem));
    tables.iter().filter_map(|table| table.lacks_values()).for_each(|problem| problems.push(problem));
    if let Some(first) = schedule.first_step_end() {
        let late = tables.iter().filter_map(|table| table.begins_late([first, schedule.end_time]));
        late.for_each(|problem| problems.push(problem));
    }
    let of_blocks = system.elements.iter().chain(&system.conditions).flat_map(|block| block.warnings());
    of_blocks.for_each(|warning| problems.push(warning.clone()));
    warn_of_height(part, &mut problems);
    warn_of_collapsed(part, &mut problems);
    warn_of_twins(part, &mut problems);
    warn_of_coincident_nodes(part, surfaces, &mut problems);
    warn_of_loose_loads(part, &mut problems);
    warn_of_loads_given_twice(part, processes, &mut problems);
    warn_of_supported_loads(part, &system.dofs, processes, [middle, schedule.end_time], &mut problems);
    report_unresisted_loads(part, system, &prescriptions(part, processes, middle), &mut problems);
    warn_of_body_loads(part, system, processes, &mut problems);
    warn_of_contradictions(part, processes, [middle, schedule.end_time], &mut problems);
    let times = schedule.first_step_end().into_iter().chain([middle, schedule.end_time]);
    problems
        .absorb(times.map(|time| check_constraints(part, &system.dofs, processes, time)).collect::<Result<Vec<()>>>());
    let is_static = matches!(solver.scheme()?, TimeScheme::Implicit(scheme) if scheme.is_static());
    if !is_static && part.info.step == 0 {
        warn_of_no_inertia(part, &mut problems);
    }
    let mut contact_restrains = None;
    if is_static && part.info.step == 0 {
        let prescribed = prescriptions(part, processes, middle);
        let along: Vec<_> = processes.iter().filter_map(|process| process.prescribes_along(part, middle)).collect();
        contact_restrains = Some(report_restraints(part, system, &prescribed, &along, &mut problems));
        // Later stages may release what earlier ones have loaded.
        if schedule.start_time <= 0.0 {
            warn_of_no_load(part, system, processes, &mut problems);
        }
    }
    Ok((problems_of_all(&model.ranks, problems)?.finish()?, contact_restrains))
}
