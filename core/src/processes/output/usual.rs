//! Default contents of a picture, where the deck names nothing.

use super::gauss::is_given;
use super::quantity::{GaussQuantity, Quantity};
use crate::assembly::System;
use crate::communication::Ranks;
use crate::model::{EntityRole, ModelPart, Rates, SubPart, UsualResults};

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

/// Default variables that elements of any rank give at their Gauss points; collective.
pub(super) fn gauss(part: &ModelPart, system: &System) -> Vec<GaussQuantity> {
    let all = UsualResults::gauss().into_iter().filter_map(|name| GaussQuantity::new(name).ok());
    all.filter(|quantity| part.ranks.any(is_given(part, system, quantity))).collect()
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
