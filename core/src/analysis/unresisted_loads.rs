//! Loads at nodes on unknowns that nothing resists.

use std::collections::BTreeSet;

use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Report, coordinates};
use crate::entities::EntityBlock;
use crate::model::{ModelPart, NodeUnknown};
use crate::processes::Prescription;

/// Adds the unknowns of a block at the nodes of its entities.
fn add_unknowns(block: &dyn EntityBlock, wanted: &dyn Fn(u32) -> bool, out: &mut BTreeSet<NodeUnknown>) {
    for at in 0..block.len() {
        let nodes = block.nodes(at);
        let own = block.unknowns().iter().map(|unknown| (nodes[usize::from(unknown.node)], unknown.variable));
        out.extend(own.filter(|&(node, _)| wanted(node)));
    }
}

/// An error for conditions at nodes that load unknowns which no element, constraint, support or interaction has: the system is singular.
///
/// On several ranks elements may be elsewhere: there nothing is said.
pub(super) fn report_unresisted_loads(
    part: &ModelPart,
    system: &System,
    prescribed: &[Prescription],
    problems: &mut Report,
) {
    if part.share.is_some() {
        return;
    }
    let is_nodal = |block: &dyn EntityBlock| (0..block.len()).all(|at| block.nodes(at).len() == 1);
    let (nodal, others): (Vec<_>, Vec<_>) = system.conditions.iter().partition(|block| is_nodal(block.as_ref()));
    let mut loaded = BTreeSet::new();
    nodal.iter().for_each(|block| add_unknowns(block.as_ref(), &|_| true, &mut loaded));
    if loaded.is_empty() {
        return;
    }
    let nodes: BTreeSet<u32> = loaded.iter().map(|(node, _)| *node).collect();
    let mut resisted = BTreeSet::new();
    for block in system.elements.iter().chain(others) {
        add_unknowns(block.as_ref(), &|node| nodes.contains(&node), &mut resisted);
    }
    for constraint in part.constraints.iter().filter(|own| own.set.is_none()) {
        resisted.insert(constraint.slave);
        resisted.extend(constraint.masters.iter().map(|(unknown, _)| *unknown));
    }
    for own in prescribed {
        resisted.extend(own.values.iter().map(|&(node, _)| (node, own.variable)));
    }
    let mut open = loaded.difference(&resisted).filter(|(node, variable)| !part.nodes.is_fixed(*variable, *node));
    let Some(&(node, variable)) = open.next() else { return };
    let others = open.count();
    let more = if others > 0 { format!(", and {others} more of nodes with loads,") } else { String::new() };
    let fact = format!(
        "{variable} of node {} at {}{more} has a condition for loads, and no element, coupling or support resists it",
        part.nodes.ids[node as usize],
        coordinates(part.nodes.initial[node as usize])
    );
    let remedy = "put the condition at a node of an element or at the reference node of a coupling, or take it out";
    problems.push(Diagnostic::error("unresisted-load", fact).remedy(remedy));
}
