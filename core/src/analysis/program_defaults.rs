//! Defaults of another program, for a deck that asks for them: `--like kratos`, or `"like"` of `problem_data`.
//!
//! Each registered object gives in its `like` the default of that program. These values are put into the deck before anything reads it,
//! so that they are settings like any other and nothing else knows of them.

use std::collections::BTreeSet;

use super::older_decks::for_each_process;
use super::solver::{SolverExtensionEntry, solver_entry};
use crate::diagnostics::{Diagnostic, Report, Result, did_you_mean};
use crate::parameters::{Defaults, Node, Object, Value};
use crate::registry::{self, Entry};

/// Program whose defaults are used for a stage: `asked` of the caller, else that of its `problem_data`; `None` for our own.
///
/// # Errors
/// `unknown-program` with the names there are.
pub(super) fn program(deck: &Node, asked: Option<&str>) -> Result<Option<&'static str>> {
    let written = deck.get_path("problem_data.like").filter(|node| !node.is_null());
    let (name, place) = match (asked, written) {
        (Some(name), _) => (name, None),
        (None, Some(node)) => (node.str()?, Some(node.place())),
        (None, None) => return Ok(None),
    };
    let known: BTreeSet<&'static str> =
        registry::entries().into_iter().flat_map(|(_, entry)| entry.like).map(|(program, _)| *program).collect();
    if let Some(found) = known.get(name) {
        return Ok(Some(found));
    }
    let known: Vec<&str> = known.into_iter().collect();
    let remedy = did_you_mean(name, known.iter().copied()).unwrap_or_else(|| format!("there is: {}", known.join(", ")));
    let problem = Diagnostic::error("unknown-program", format!("no defaults are known of {name:?}")).remedy(remedy);
    Err(place.map_or(problem.clone(), |place| problem.at(place)).into())
}

/// Adds the defaults of `program` to the deck's solver settings and processes; returns the additions, as `object.key = value`.
///
/// # Errors
/// Objects whose values for this program are no JSON.
pub(super) fn apply_program_defaults(deck: &mut Node, program: &str, report: &mut Report) -> Result<Vec<String>> {
    let mut added = Vec::new();
    let Value::Object(top) = &mut deck.value else { return Ok(added) };
    if let Some(solver) = top.get_mut("solver_settings") {
        // A solver that is not known is reported where the settings are read.
        if let Ok(entry) = solver_entry(solver) {
            apply_values(solver, entry, program, &mut added)?;
        }
        if let Value::Object(members) = &mut solver.value {
            for entry in registry::all::<SolverExtensionEntry>() {
                if let Some(settings) = members.get_mut(entry.name) {
                    apply_values(settings, entry, program, &mut added)?;
                    // An extension may be a solver beside the first.
                    if let Ok(entry) = solver_entry(settings)
                        && settings.get("solver_type").is_some()
                    {
                        apply_values(settings, entry, program, &mut added)?;
                    }
                }
            }
        }
    }
    for_each_process(deck, |entry, parameters| {
        if let Some(entry) = entry {
            let applied = apply_values(parameters, entry, program, &mut added);
            report.absorb(applied);
        }
    });
    Ok(added)
}

/// Completes one object by the values that `program` has for it.
fn apply_values(settings: &mut Node, entry: &Entry, program: &str, added: &mut Vec<String>) -> Result<()> {
    let Some((_, text)) = entry.like.iter().find(|(name, _)| *name == program) else { return Ok(()) };
    let values = Defaults::parse(entry.name, text)?;
    complete(settings, values.node(), entry.name, added);
    Ok(())
}

fn complete(settings: &mut Node, values: &Node, name: &str, added: &mut Vec<String>) {
    let place = settings.place();
    let (Value::Object(own), Some(values)) = (&mut settings.value, values.as_object()) else { return };
    for value in values.in_source_order() {
        let path = format!("{name}.{}", value.key);
        let nested = value.node.as_object().is_some_and(|object| !object.is_empty());
        if nested && own.get(&value.key).is_none() {
            own.insert(value.at(&place).with(Value::Object(Object::default())));
        }
        match own.get_mut(&value.key) {
            Some(node) => complete(node, &value.node, &path, added),
            None => {
                added.push(format!("{path} = {}", value.node));
                own.insert(value.at(&place));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::Document;

    #[test]
    fn what_a_deck_names_stays() {
        let mut deck = Document::from_str(r#"{ "a": 1, "inner": { "b": 2 } }"#, "deck.json").unwrap().root;
        let values = r#"{ "a": 5, "c": "x", "inner": { "b": 6, "d": 7 }, "other": { "e": 8 } }"#;
        let mut added = Vec::new();
        complete(&mut deck, Defaults::parse("thing", values).unwrap().node(), "thing", &mut added);
        let applied = r#"{"a":1,"c":"x","inner":{"b":2,"d":7},"other":{"e":8}}"#;
        assert_eq!(deck.to_json().to_string(), applied);
        assert_eq!(added, ["thing.c = \"x\"", "thing.inner.d = 7", "thing.other.e = 8"]);
        assert_eq!(deck.get_path("inner.d").unwrap().place().to_string(), "deck.json:1:20");
    }
}
