//! Linear relations between displacements as constraints of an mdpa file.

use std::collections::BTreeMap;

use rustc_hash::FxHashSet;
use zelus_core::diagnostics::{Diagnostic, Place};
use zelus_core::io::mdpa::{Constraint, ConstraintBlock};

use super::mesh::Mesh;

const VARIABLES: [&str; 3] = ["DISPLACEMENT_X", "DISPLACEMENT_Y", "DISPLACEMENT_Z"];

/// Index of a node, and direction from 0.
type Unknown = (u32, usize);

/// Factors below this share of the largest of an equation are round-off of others.
const ROUND_OFF: f64 = 1e-12;

/// A constraint for each equation. The first unknown that nothing else prescribes follows the others; an equation without one is
/// reported.
pub(super) fn constraints(mesh: &Mesh, place: &Place, said: &mut Vec<Diagnostic>) -> Vec<ConstraintBlock> {
    let mut taken: FxHashSet<Unknown> = FxHashSet::default();
    for support in mesh.supports.iter().filter(|support| support.axes.is_none()) {
        let Some(group) = mesh.group(&support.group) else { continue };
        let of_cells = group.cells.iter().flat_map(|&cell| mesh.cells.nodes(cell as usize));
        for &node in group.nodes.iter().chain(of_cells) {
            let held = (0..3).filter(|&direction| support.values[direction].is_some());
            taken.extend(held.map(|direction| (node, direction)));
        }
    }
    // each unknown that follows, by unknowns that do not: equations are eliminated one after the other
    let mut relations: BTreeMap<Unknown, BTreeMap<Unknown, f64>> = BTreeMap::new();
    let mut lost = 0;
    for equation in &mesh.equations {
        let mut terms: BTreeMap<Unknown, f64> = BTreeMap::new();
        for &(node, direction, factor) in &equation.terms {
            match relations.get(&(node, direction)) {
                Some(known) => {
                    known.iter().for_each(|(own, weight)| *terms.entry(*own).or_default() += factor * weight)
                }
                None => *terms.entry((node, direction)).or_default() += factor,
            }
        }
        let largest = terms.values().fold(0.0_f64, |most, factor| most.max(factor.abs()));
        terms.retain(|_, factor| factor.abs() > ROUND_OFF * largest);
        let is_free = |unknown: &Unknown| terms.contains_key(unknown) && !taken.contains(unknown);
        let in_order = equation.terms.iter().map(|term| (term.0, term.1)).chain(terms.keys().copied());
        let Some(slave) = in_order.into_iter().find(is_free) else {
            lost += usize::from(!terms.is_empty());
            continue;
        };
        let own = terms.remove(&slave).unwrap_or(1.0);
        let masters: BTreeMap<Unknown, f64> =
            terms.into_iter().map(|(unknown, factor)| (unknown, -factor / own)).collect();
        for known in relations.values_mut() {
            let Some(weight) = known.remove(&slave) else { continue };
            masters.iter().for_each(|(unknown, factor)| *known.entry(*unknown).or_default() += weight * factor);
        }
        relations.insert(slave, masters);
    }
    let mut blocks: BTreeMap<Vec<&str>, Vec<Constraint>> = BTreeMap::new();
    for (id, ((node, direction), masters)) in (1..).zip(relations) {
        let mut names = vec![VARIABLES[direction]];
        names.extend(masters.keys().map(|unknown| VARIABLES[unknown.1]));
        let is_alike = names.iter().all(|name| *name == names[0]);
        let key = if is_alike { vec![names[0]] } else { names };
        blocks.entry(key).or_default().push(Constraint {
            id,
            constant: 0.0,
            weights: masters.values().copied().collect(),
            slave: mesh.node_ids[node as usize],
            masters: masters.keys().map(|unknown| mesh.node_ids[unknown.0 as usize]).collect(),
        });
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
