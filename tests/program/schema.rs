//! `zelus schema`: every deck of this repository is valid by it, and decks with mistakes are not.

use crate::support;
use std::path::{Path, PathBuf};

use crate::support::{read_json, root, said, zelus};
use jsonschema::Validator;
use serde_json::{Value, json};
use zelus_core::parameters::Document;

fn schema(of: &str) -> Validator {
    let output = zelus(&root(), &["schema", of]);
    assert!(output.status.success(), "{}", said(&output));
    let schema = serde_json::from_slice(&output.stdout).expect("JSON");
    jsonschema::draft202012::meta::validate(&schema).unwrap_or_else(|problem| panic!("{of}: {problem}"));
    jsonschema::draft202012::new(&schema).expect("a schema")
}

/// Every JSON file below these folders.
fn files(mut pending: Vec<PathBuf>) -> Vec<PathBuf> {
    let mut found = Vec::new();
    while let Some(folder) = pending.pop() {
        for path in std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
            if path.is_dir() {
                pending.push(path);
            } else if path.extension().is_some_and(|end| end == "json") {
                found.push(path);
            }
        }
    }
    found
}

/// Whether it is a deck or a file of materials.
fn sort(value: &Value) -> Option<&'static str> {
    let is_deck = value.get("solver_settings").is_some() || value.get("orchestrator").is_some();
    let is_materials = value.get("properties").is_some_and(Value::is_array);
    if is_deck { Some("deck") } else { is_materials.then_some("materials") }
}

fn problems(validator: &Validator, value: &Value, path: &Path) -> Vec<String> {
    let all = validator.iter_errors(value);
    all.map(|problem| format!("{}: {}: {problem}", path.display(), problem.instance_path())).collect()
}

#[test]
fn every_deck_of_the_repository_is_valid() {
    let validators = [("deck", schema("deck")), ("materials", schema("materials"))];
    let shared = std::env::var("ZELUS_SHARED").map_or_else(|_| root().join("../shared"), PathBuf::from).join("decks");
    let folders = [root().join("examples"), root().join("tests/cases"), root().join("tests/heat"), shared];
    // Decks of the plugin name its objects; one deck is there for its old form, of which warnings tell.
    let others = [root().join("examples/plugin"), root().join("tests/cases/structural/older_deck")];
    let (mut wrong, mut counts) = (Vec::new(), [0, 0]);
    for path in files(folders.into_iter().filter(|folder| folder.is_dir()).collect()) {
        if others.iter().any(|other| path.starts_with(other)) {
            continue;
        }
        let Ok(document) = Document::read(&path) else { continue };
        let value = document.root.to_json();
        let Some(at) = validators.iter().position(|(of, _)| Some(*of) == sort(&value)) else { continue };
        counts[at] += 1;
        wrong.extend(problems(&validators[at].1, &value, &path));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(counts[0] > 100 && counts[1] > 100, "{counts:?}");
}

#[test]
fn mistakes_are_no_valid_decks() {
    let folder = root().join("examples/hertz_line_contact");
    let good = read_json(&folder.join("ProjectParameters.json")).expect("a deck");
    let deck = schema("deck");
    assert!(deck.is_valid(&good));
    let contact = "/processes/contact_process_list/0";
    for (place, value) in [
        ("/solver_settings/max_iteration", json!("many")),
        ("/solver_settings/max_iteration", json!(2.5)),
        ("/solver_settings/max_iterations", json!(20)),
        ("/solver_settings/solver_type", json!("Statik")),
        ("/solver_settings/convergence_criterion", json!("contact_criterion")),
        ("/solver_settings/contact_settings", json!({ "mortar": "ALMContactFrictionless" })),
        ("/solver_settings/time_stepping", json!({ "time_step": -1.0 })),
        ("/solver_settings/model_import_settings/input_type", json!("gmhs")),
        ("/problem_data/end_time", json!("late")),
        ("/outputs", json!({})),
        (&*format!("{contact}/python_module"), json!("alm_contact")),
        (&*format!("{contact}/Parameters/contact_type"), json!(1)),
        (&*format!("{contact}/Parameters/contact_parts"), json!({})),
        (&*format!("{contact}/Parameters/search_parameters"), json!({ "search_factor": true })),
        ("/processes/loads_process_list/0/Parameters/variable_name", json!("LINE_LAOD")),
    ] {
        let mut bad = good.clone();
        let (parent, key) = place.rsplit_once('/').expect("a place");
        bad.pointer_mut(parent).expect("an object")[key] = value;
        assert!(!deck.is_valid(&bad), "{place} is taken");
    }
    let good = read_json(&folder.join("StructuralMaterials.json")).expect("materials");
    let materials = schema("materials");
    assert!(materials.is_valid(&good));
    for (place, value) in [
        ("/properties/0/Material/constitutive_law/name", json!("LinearElasticLaw")),
        ("/properties/0/Material/Variables/YOUNG_MODULUS", json!("stiff")),
        ("/properties/0/Material/Variables/YOUNGS_MODULUS", json!(1.0)),
        ("/properties/0/model_part", json!("Structure")),
    ] {
        let mut bad = good.clone();
        let (parent, key) = place.rsplit_once('/').expect("a place");
        bad.pointer_mut(parent).expect("an object")[key] = value;
        assert!(!materials.is_valid(&bad), "{place} is taken");
    }
}

#[test]
fn a_deck_may_name_its_schema() {
    let scratch = support::scratch_copy(&root().join("examples/hertz_line_contact"));
    for file in ["ProjectParameters.json", "StructuralMaterials.json"] {
        let path = scratch.path().join(file);
        let mut value = read_json(&path).expect("JSON");
        value["$schema"] = json!("./schema.json");
        std::fs::write(path, value.to_string()).expect("a file");
    }
    let output = zelus(scratch.path(), &["check", "ProjectParameters.json"]);
    assert!(output.status.success() && !said(&output).contains("$schema"), "{}", said(&output));
}
