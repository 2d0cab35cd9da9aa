//! Decks of earlier Kratos versions, put into the form of the present one; each habit is named once.

use crate::diagnostics::{Diagnostic, Place, Report};
use crate::model::Model;
use crate::parameters::{Node, Object, Value};
use crate::processes::ProcessEntry;
use crate::registry::{self, Entry};

use super::solver::solver_entry;

/// Lists of processes that stood at the top level.
const LISTS: [&str; 8] = [
    "constraints_process_list",
    "loads_process_list",
    "list_other_processes",
    "contact_process_list",
    "json_output_process",
    "json_check_process",
    "check_analytic_results_process",
    "list_other_output_processes",
];

/// The settings of GiD's output, which stood at the top level, too.
const GID: &str = "output_configuration";

/// Name of the part that was made of all that is computed.
const COMPUTED: &str = "computing_domain";

/// Keys that name a part below the one of `"model_part_name"`.
const BELOW_ROOT: [&str; 2] = ["first_model_part_name", "second_model_part_name"];

/// The same deck with its lists of processes in `processes`, and no `mesh_id` of 0, a number without meaning.
pub(super) fn modernise(deck: &Node, report: &mut Report) -> Node {
    let mut deck = deck.clone();
    // A solver that is not known is reported where the settings are read.
    if let Some(Ok(entry)) = deck.get("solver_settings").map(solver_entry) {
        let unfolded = (entry.build.unfold)(&mut deck);
        report.absorb(unfolded);
    }
    let gid = gid_output(&deck);
    let Value::Object(top) = &mut deck.value else { return deck };
    for key in LISTS {
        let Some(list) = top.get(key).filter(|node| node.as_array().is_some()) else { continue };
        if top.get("processes").is_some_and(|lists| lists.get(key).is_some()) {
            continue;
        }
        let place = list.place();
        move_into(top, key, "processes", key);
        let fact = format!("\"{key}\" at the top level is an old form; it is read as a list of \"processes\"");
        report.push(Diagnostic::warning("old-deck", fact).at(place).remedy("put the list inside \"processes\""));
    }
    if let Some(list) = gid {
        let place = top.get(GID).map(Node::place);
        if let Some(member) = top.get_mut(GID) {
            *member = list;
        }
        move_into(top, GID, "output_processes", "gid_output");
        let fact = format!("\"{GID}\" at the top level is an old form; it is read as a gid_output_process");
        let remedy = "put a gid_output_process with it as \"postprocess_parameters\" into \"output_processes\"";
        report.push(Diagnostic::warning("old-deck", fact).at(place).remedy(remedy));
    }
    let mut places = Vec::new();
    for_each_process(&mut deck, |_, parameters| {
        let Value::Object(parameters) = &mut parameters.value else { return };
        if parameters.get("mesh_id").and_then(Node::as_i64) == Some(0)
            && let Some(member) = parameters.remove("mesh_id")
        {
            places.push(member.node.place());
        }
    });
    if let Some(first) = places.first() {
        let fact = format!("\"mesh_id\" of {} processes is read by nobody any more", places.len());
        report.push(Diagnostic::warning("deprecated-key", fact).at(first.clone()).remedy("remove \"mesh_id\""));
    }
    deck
}

/// Replaces parts that processes name without the root part, and the part of all that is computed, by their full path.
pub(super) fn complete_part_names(deck: &mut Node, root: &str, model: &Model, report: &mut Report) {
    let Ok(part) = model.root(root) else { return };
    let mut found: Vec<(Place, String, Diagnostic)> = Vec::new();
    for_each_process(deck, |process, parameters| {
        if process.is_some_and(|entry| entry.defaults.contains("\"main_model_part_name\"")) {
            return;
        }
        let Value::Object(parameters) = &mut parameters.value else { return };
        let names_full_path =
            |key: &&str| key.ends_with("model_part_name") && !key.starts_with("sub_") && !BELOW_ROOT.contains(key);
        let keys: Vec<String> = parameters.keys().filter(names_full_path).map(str::to_owned).collect();
        for key in keys {
            let Some(node) = parameters.get_mut(&key) else { continue };
            let Some(name) = node.as_str() else { continue };
            let below = name.strip_prefix(&part.name).map_or(name, |rest| rest.trim_start_matches('.'));
            let full = match below {
                COMPUTED if part.part(COMPUTED).is_err() => {
                    Some((part.name.clone(), all_is_computed(name, &part.name)))
                }
                _ if model.root(name).is_ok() => None,
                _ => part.named_without_root(name),
            };
            if let Some((full, warning)) = full {
                found.push((node.place(), name.to_owned(), warning));
                node.value = Value::String(full);
            }
        }
    });
    let mut said: Vec<String> = Vec::new();
    for (place, name, warning) in found {
        if !said.contains(&name) {
            said.push(name);
            report.push(warning.at(place));
        }
    }
}

fn all_is_computed(name: &str, root: &str) -> Diagnostic {
    let fact = format!("there is no part {name:?}: all of {root:?} is computed, and taken");
    Diagnostic::warning("old-deck", fact).remedy(format!("write \"{root}\""))
}

/// Does something to the parameters of each process, of which the registered entry is given where there is one.
pub(super) fn for_each_process(deck: &mut Node, mut change: impl FnMut(Option<&Entry>, &mut Node)) {
    let Value::Object(top) = &mut deck.value else { return };
    for section in ["processes", "output_processes"] {
        let Some(Node { value: Value::Object(lists), .. }) = top.get_mut(section) else { continue };
        let keys: Vec<String> = lists.keys().map(str::to_owned).collect();
        for key in keys {
            let Some(Node { value: Value::Array(items), .. }) = lists.get_mut(&key) else { continue };
            for item in items {
                let Value::Object(process) = &mut item.value else { continue };
                let module = process.get("python_module").or_else(|| process.get("name")).and_then(Node::as_str);
                let entry = module.and_then(|path| registry::find::<ProcessEntry>(path.rsplit('.').next()?));
                if let Some(parameters) = process.get_mut("Parameters").filter(|node| node.as_object().is_some()) {
                    change(entry.map(|entry| &**entry), parameters);
                }
            }
        }
    }
}

/// Moves a member of `top` into one of its objects, which is made where there is none.
fn move_into(top: &mut Object, key: &str, section: &str, name: &str) {
    let Some(mut member) = top.remove(key) else { return };
    if top.get(section).is_none() {
        let mut made = member.clone();
        section.clone_into(&mut made.key);
        made.node.value = Value::Object(Object::default());
        top.insert(made);
    }
    if let Some(Node { value: Value::Object(lists), .. }) = top.get_mut(section) {
        name.clone_into(&mut member.key);
        lists.insert(member);
    }
}

/// Output process that corresponds to the old settings of GiD's output.
fn gid_output(deck: &Node) -> Option<Node> {
    let settings = deck.get(GID)?;
    settings.as_object()?;
    let part = deck.get_path("solver_settings.model_part_name")?.as_str()?;
    let name = deck.get_path("problem_data.problem_name").and_then(Node::as_str).unwrap_or(part);
    let json = serde_json::json!([{
        "python_module": "gid_output_process",
        "Parameters": {"model_part_name": part, "output_name": name, "postprocess_parameters": settings.to_json()}
    }]);
    Node::from_json(&json, &settings.place()).ok()
}
