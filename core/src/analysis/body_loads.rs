//! Body loads and inertia that elements cannot take, since their properties lack the number which they multiply.

use std::collections::BTreeSet;

use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Report};
use crate::model::ModelPart;
use crate::processes::{LoadCarrier, Process};

/// Warns of body loads, e.g. gravity, on elements whose properties give no density; collective.
pub(super) fn warn_of_body_loads(
    part: &ModelPart,
    system: &System,
    processes: &[Box<dyn Process>],
    problems: &mut Report,
) {
    let driving = processes.iter().filter(|process| process.drives(part, system));
    let loads = driving.flat_map(|process| process.loads(part));
    for load in loads.filter(|load| matches!(load.on, LoadCarrier::History | LoadCarrier::Nodes)) {
        let found = MissingFactors::of(part, |at, variable| {
            let holds = |node: &u32| load.members.binary_search(node).is_ok();
            load.variables.iter().any(|own| own.column == variable) && part.elements.nodes(at).iter().any(holds)
        });
        let Some((names, factor)) = found.names() else { continue };
        let reach = if found.others_take { "does not act on all elements" } else { "acts on nothing" };
        let fact = format!("{} by {} {reach}: {names} no {factor}", load.variables[0].column, load.by);
        let problem = Diagnostic::warning("acts-on-nothing", fact).at(load.place.clone());
        problems
            .push(problem.remedy(format!("give {factor} in the materials, or take the bodies out of the load's part")));
    }
}

/// Warns of elements that take part in a dynamic analysis without mass, where no property says that it is zero; collective.
pub(super) fn warn_of_no_inertia(part: &ModelPart, problems: &mut Report) {
    let found = MissingFactors::of(part, |at, _| {
        let factor = part.elements.kinds[at as usize].body_load.map(|(_, factor)| factor);
        let properties = part.properties.get(&part.elements.properties[at as usize]);
        factor.zip(properties).is_some_and(|(factor, properties)| properties.number(factor).is_none())
    });
    let Some((names, factor)) = found.names() else { return };
    let fact = format!("a dynamic analysis, but {names} no {factor}: those elements have no mass");
    let remedy = format!("give {factor} in the materials, 0 where a body is meant to have no mass");
    problems.push(Diagnostic::warning("no-mass", fact).remedy(remedy));
}

/// Properties of elements that lack the factor of their body loads.
struct MissingFactors {
    ids: BTreeSet<usize>,
    factor: Option<&'static str>,
    /// Whether other elements have theirs.
    others_take: bool,
}

impl MissingFactors {
    /// Properties of the elements that `concerns` chooses by their place and the variable of their body load; collective.
    fn of(part: &ModelPart, concerns: impl Fn(u32, &'static str) -> bool) -> Self {
        let mut own = Self { ids: BTreeSet::new(), factor: None, others_take: false };
        for at in 0..part.elements.len() as u32 {
            let Some((variable, factor)) = part.elements.kinds[at as usize].body_load else { continue };
            own.factor = Some(factor);
            let id = part.elements.properties[at as usize];
            let takes = part.properties.get(&id).and_then(|own| own.number(factor)).is_some_and(|number| number != 0.0);
            let is_known = if takes { own.others_take } else { own.ids.contains(&id) };
            if is_known || !concerns(at, variable) {
                continue;
            }
            if takes {
                own.others_take = true;
            } else {
                own.ids.insert(id);
            }
        }
        let ids: Vec<f64> = own.ids.into_iter().map(|id| id as f64).collect();
        own.ids = part.ranks.gather_numbers(&ids).concat().into_iter().map(|id| id as usize).collect();
        own.others_take = part.ranks.any(own.others_take);
        own
    }

    /// The properties in words and the factor; `None` where none lacks it.
    fn names(&self) -> Option<(String, &'static str)> {
        let ids: Vec<String> = self.ids.iter().map(ToString::to_string).collect();
        let names = if ids.len() == 1 {
            format!("property {} has", ids[0])
        } else {
            format!("properties {} have", ids.join(", "))
        };
        self.factor.filter(|_| !ids.is_empty()).map(|factor| (names, factor))
    }
}
