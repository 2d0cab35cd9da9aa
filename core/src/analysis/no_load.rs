//! Models that nothing loads or moves.

use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Report};
use crate::entities::{EntityBlock, LocalSystems, Request};
use crate::model::ModelPart;
use crate::processes::Process;
use crate::vector3::{norm, sub};

/// Entities whose forces are computed at a time.
const AT_A_TIME: usize = 256;
/// Force of an element, in its stiffness times its size, that is none.
const ROUND_OFF: f64 = 1e-12;

/// Warns of a model in static equilibrium from the start: no process gives a load or a motion, every unknown begins at
/// zero, and no element and no interaction begins with forces. Collective.
pub(super) fn warn_of_no_load(
    part: &ModelPart,
    system: &System,
    processes: &[Box<dyn Process>],
    problems: &mut Report,
) {
    let drives = processes.iter().any(|process| process.drives(part, system))
        || system.interactions.iter().any(|interaction| interaction.drives())
        || system.dofs.gather(part, 0).iter().any(|value| *value != 0.0)
        || system.elements.iter().chain(&system.conditions).any(|block| begins_with_forces(block.as_ref(), part));
    if part.ranks.any(drives) {
        return;
    }
    let fact = "nothing loads or moves the model: no process gives a load or a motion other than zero, and the initial state is \
                without forces";
    let remedy = "add a load, e.g. by assign_vector_by_direction_to_condition_process, or prescribe a displacement; \
                  `zelus describe` of a process shows an example";
    problems.push(Diagnostic::warning("no-load", fact).remedy(remedy));
}

/// Whether an entity of a block has forces in the present state, or cannot be computed in it.
fn begins_with_forces(block: &dyn EntityBlock, part: &ModelPart) -> bool {
    let size = block.unknowns().len();
    let mut out = LocalSystems::default();
    (0..block.len()).step_by(AT_A_TIME).any(|first| {
        let range = first..block.len().min(first + AT_A_TIME);
        out.reset(range.len(), size, Request::Both);
        if block.local_systems(&part.view(), range.clone(), Request::Both, &mut out).is_err() {
            return true;
        }
        range.enumerate().any(|(at, entity)| {
            let (lhs, rhs) = out.entity(at);
            let nodes = block.nodes(entity);
            let place = |node: u32| part.nodes.initial[node as usize];
            let reach = nodes.iter().map(|&node| norm(sub(place(node), place(nodes[0])))).fold(0.0, f64::max);
            let stiffness = lhs.iter().fold(0.0_f64, |most, entry| most.max(entry.abs()));
            rhs.iter().any(|force| force.abs() > ROUND_OFF * stiffness * reach)
        })
    })
}
