//! Linear relations between displacements as constraints of an mdpa file.

use std::collections::BTreeMap;

use rustc_hash::FxHashSet;
use zelus_core::diagnostics::{Diagnostic, Place};
use zelus_core::io::mdpa::{Constraint, ConstraintBlock};

use super::mesh::Mesh;

const VARIABLES: [&str; 3] = ["DISPLACEMENT_X", "DISPLACEMENT_Y", "DISPLACEMENT_Z"];

/// A constraint for each equation. The first unknown that nothing else prescribes follows the others; an equation without one is
/// reported.
pub(super) fn constraints(mesh: &Mesh, place: &Place, said: &mut Vec<Diagnostic>) -> Vec<ConstraintBlock> {
    let mut taken: FxHashSet<(u32, usize)> = FxHashSet::default();
    for support in mesh.supports.iter().filter(|support| support.axes.is_none()) {
        let Some(group) = mesh.group(&support.group) else { continue };
        let of_cells = group.cells.iter().flat_map(|&cell| mesh.cells.nodes(cell as usize));
        for &node in group.nodes.iter().chain(of_cells) {
            let held = (0..3).filter(|&direction| support.values[direction].is_some());
            taken.extend(held.map(|direction| (node, direction)));
        }
    }
    let masters_of_all = mesh.equations.iter().flat_map(|own| own.terms.iter().skip(1));
    let masters: FxHashSet<(u32, usize)> = masters_of_all.map(|&(node, direction, _)| (node, direction)).collect();
    let mut blocks: BTreeMap<Vec<&str>, Vec<Constraint>> = BTreeMap::new();
    let (mut next, mut lost) = (1, 0);
    for equation in &mesh.equations {
        let is_free = |term: &&(u32, usize, f64)| term.2 != 0.0 && !taken.contains(&(term.0, term.1));
        let terms = &equation.terms;
        // a slave that no other equation uses, where there is one
        let alone = terms.iter().take(1).chain(terms.iter().filter(|term| !masters.contains(&(term.0, term.1))));
        let Some(slave) = alone.into_iter().find(is_free).or_else(|| terms.iter().find(is_free)).copied() else {
            lost += 1;
            continue;
        };
        taken.insert((slave.0, slave.1));
        let others: Vec<_> = terms.iter().filter(|term| (term.0, term.1) != (slave.0, slave.1)).collect();
        let mut names = vec![VARIABLES[slave.1]];
        names.extend(others.iter().map(|term| VARIABLES[term.1]));
        let is_alike = names.iter().all(|name| *name == names[0]);
        let key = if is_alike { vec![names[0]] } else { names };
        blocks.entry(key).or_default().push(Constraint {
            id: next,
            constant: 0.0,
            weights: others.iter().map(|term| -term.2 / slave.2).collect(),
            slave: mesh.node_ids[slave.0 as usize],
            masters: others.iter().map(|term| mesh.node_ids[term.0 as usize]).collect(),
        });
        next += 1;
    }
    if lost > 0 {
        let fact = format!("{lost} equations relate prescribed unknowns alone and are left out");
        said.push(Diagnostic::warning("not-taken-over", fact).at(place.clone()));
    }
    let block = |(variables, rows): (Vec<&str>, Vec<Constraint>)| {
        let is_mixed = variables.len() > 1;
        let name = if is_mixed { "LinearMasterSlaveConstraintOfComponents" } else { "LinearMasterSlaveConstraint" };
        let variables: Vec<String> = if is_mixed {
            variables.into_iter().map(str::to_owned).collect()
        } else {
            [variables[0], variables[0]].map(str::to_owned).to_vec()
        };
        ConstraintBlock { name: name.to_owned(), variables, rows, ..ConstraintBlock::default() }
    };
    blocks.into_iter().map(block).collect()
}
