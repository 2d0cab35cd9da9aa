//! Checks that the names in the lists of a deck exist in the place that each list refers to.

use super::gauss::is_known;
use super::quantity::{GaussQuantity, Quantity};
use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Place};
use crate::model::{EntityRole, ModelPart, named};

/// The lists of a picture: keys of the deck.
const HISTORY: &str = "nodal_solution_step_data_variables";
const VALUES: &str = "nodal_data_value_variables";
const GAUSS: &str = "gauss_point_variables_extrapolated_to_nodes";

/// The list that knows a variable, other than `asked`; `None` where none does.
fn better(name: &str, asked: &str, part: &ModelPart, system: &System) -> Option<&'static str> {
    let column = named(name)?.column().0;
    let gauss = GaussQuantity::new(name).is_ok_and(|quantity| is_known(system, EntityRole::Element, &quantity));
    let lists = [(HISTORY, part.nodes.history.has(column)), (VALUES, part.nodes.values.has(column)), (GAUSS, gauss)];
    if lists.iter().any(|(list, knows)| *list == asked && *knows) {
        return None;
    }
    // processes write into columns without history during a run, such as extrapolated values
    let lists = if asked == VALUES { &lists[..1] } else { &lists[..] };
    lists.iter().find(|(_, knows)| *knows).map(|(list, _)| *list)
}

/// Errors for names that another list knows, and these do not: they would be written as zeros.
pub(super) fn check(
    part: &ModelPart,
    system: &System,
    place: &Place,
    history: &[Quantity],
    values: &[Quantity],
    gauss: &[GaussQuantity],
) -> Vec<Diagnostic> {
    let names = history.iter().map(|quantity| (quantity.name.as_str(), HISTORY));
    let names = names.chain(values.iter().map(|quantity| (quantity.name.as_str(), VALUES)));
    let names = names.chain(gauss.iter().map(|quantity| (quantity.name.as_str(), GAUSS)));
    names
        .filter_map(|(name, asked)| {
            let list = better(name, asked, part, system)?;
            let fact = format!("\"{asked}\" has {name}, which is not there, and would be written as zeros");
            Some(Diagnostic::error("other-list", fact).at(place.clone()).remedy(format!("name it in \"{list}\"")))
        })
        .collect()
}
