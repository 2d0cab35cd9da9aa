//! Default contents of a picture, where the deck names nothing.

use std::collections::BTreeMap;

use zelus_linear_algebra::parallel;

use super::gauss::is_known;
use super::quantity::{GaussQuantity, Quantity};
use crate::assembly::System;
use crate::communication::Ranks;
use crate::io::results::Column;
use crate::model::{EntityRole, ModelPart, Rates, SubPart, UsualResults};

/// Rows of a column that a thread takes at a time, at least.
const ROWS: usize = 1 << 12;

/// Unknowns and their reactions.
pub(super) fn history(part: &ModelPart) -> Vec<Quantity> {
    let rates = Rates::within(&part.nodes.history).into_iter();
    let names = rates.flat_map(|(rates, _)| [Some(rates.unknown), rates.reaction]).flatten();
    names.filter(|name| part.nodes.history.has(name)).filter_map(|name| Quantity::new(name).ok()).collect()
}

/// Default nodal variables of the applications.
pub(super) fn values(part: &ModelPart) -> Vec<Quantity> {
    let names = UsualResults::values().into_iter().filter(|name| part.nodes.values.has(name));
    names.filter_map(|name| Quantity::new(name).ok()).collect()
}

/// Default variables that elements of any rank know at their Gauss points; collective.
pub(super) fn gauss(part: &ModelPart, system: &System) -> Vec<GaussQuantity> {
    let all = UsualResults::gauss().into_iter().filter_map(|name| GaussQuantity::new(name).ok());
    all.filter(|quantity| part.ranks.any(is_known(system, EntityRole::Element, quantity))).collect()
}

/// The largest size at a node of each of them, by name, over all ranks; collective.
pub fn largest_results(part: &ModelPart) -> BTreeMap<String, f64> {
    let nodes: Vec<u32> = (0..part.nodes.len() as u32).collect();
    let largest = |column: Column| {
        let components = column.components.max(1);
        let size = |row: usize| {
            let entries = (row * components..(row + 1) * components).map(|at| column.values.get(at));
            entries.map(|x| x * x).sum::<f64>().sqrt()
        };
        let own = parallel::largest(column.values.len() / components, ROWS, size);
        let all = part.ranks.gather_counted(&[own], &vec![1; part.ranks.size()]);
        (column.name, all.into_iter().fold(0.0, f64::max))
    };
    let unknowns = history(part).into_iter().map(|quantity| quantity.gather(&part.nodes.history, &nodes));
    let found = values(part).into_iter().map(|quantity| quantity.gather(&part.nodes.values, &nodes));
    unknowns.chain(found).map(largest).collect()
}

/// For each of these cells the place of the first sub part that has it, from 1 in the order of names, of those that have
/// cells at all; 0 where none does. Collective.
pub(super) fn parts(ranks: &Ranks, selection: &SubPart, role: EntityRole, cells: &[u32]) -> Vec<usize> {
    let lists = selection.children.values().map(|child| match role {
        EntityRole::Element => &child.elements,
        _ => &child.conditions,
    });
    let lists: Vec<_> = lists.filter(|list| ranks.any(!list.is_empty())).collect();
    let place = |cell: &u32| lists.iter().position(|list| list.binary_search(cell).is_ok()).map_or(0, |at| at + 1);
    cells.iter().map(place).collect()
}
