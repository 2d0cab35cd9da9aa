//! What contact does only because Kratos does it: every setting that `--like kratos` lays under a deck is named with its source, and
//! switching it changes what is said here.

mod support;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde_json::{Value, json};
use support::{read_json, root, said, scratch_copy, zelus};
use zelus::contact_structural_mechanics::kratos::DEVIATIONS;

/// Settings of contact in `configs/like_kratos` that are tolerances, whose default is another number for the same thing.
const TOLERANCES: &str = "_absolute_tolerance";

/// What shows that a setting matters.
enum Witness {
    /// A case that runs as Kratos does, and changes where the setting has the default of this program.
    Case { folder: &'static str, changes: Change },
    /// A test that switches it, by its file and name.
    Test { file: &'static str, name: &'static str },
}

use Change::{Iterations, Results};
use Witness::{Case, Test};

/// What a setting changes.
enum Change {
    /// The numbers of iterations.
    Iterations,
    /// Results by at least this share of their largest value.
    Results(f64),
}

const WITNESSES: &[(&str, &str, Witness)] = &[
    (
        "alm_contact_process",
        "normal_variation",
        Case { folder: "contact_2d/hertz_spheres_light_coarse", changes: Results(1e-6) },
    ),
    ("alm_contact_process", "augmentation", Case { folder: "contact_2d/hertz_spheres_light", changes: Results(1e-7) }),
    ("alm_contact_process", "nodal_normals", Case { folder: "contact_2d/hertz_spheres_light", changes: Results(3e-8) }),
    (
        "alm_contact_process",
        "mind_supports",
        Case { folder: "contact_2d/hertz_spheres_light_coarse", changes: Results(1e-7) },
    ),
    (
        "alm_contact_process",
        "count_slivers",
        Case { folder: "contact_2d/friction_slide_millimetres", changes: Results(1e-7) },
    ),
    (
        "alm_contact_process",
        "search_parameters.search_distance",
        Case { folder: "contact_2d/dropped_deep", changes: Iterations },
    ),
    (
        "alm_contact_process",
        "search_parameters.search_within_step",
        Case { folder: "contact_2d/dropped_deep", changes: Iterations },
    ),
    (
        "alm_contact_process",
        "slip_step_reset_frequency",
        Case { folder: "contact_2d/friction_slide", changes: Iterations },
    ),
    (
        "alm_contact_process",
        "absolute_operator_threshold",
        Case { folder: "contact_2d/friction_slide_millimetres", changes: Results(1e-7) },
    ),
    (
        "penalty_contact_process",
        "tangent_factor",
        Case { folder: "contact_2d/friction_penalty_stick", changes: Results(1e-3) },
    ),
    (
        "penalty_contact_process",
        "advance_ALM_parameters.penalty_of_weighted_gaps",
        Case { folder: "contact_2d/friction_penalty_stick", changes: Results(1e-3) },
    ),
    (
        "explicit_penalty_contact_process",
        "advance_ALM_parameters.penalty_of_weighted_gaps",
        Case { folder: "contact_3d/explicit_touch", changes: Results(1e-4) },
    ),
    (
        "mpc_contact_process",
        "consistent_weights",
        Test { file: "mpc_contact.rs", name: "weights_by_facets_are_had_by_name" },
    ),
    (
        "mpc_contact_process",
        "swap_held_slaves",
        Test { file: "mpc_contact.rs", name: "sides_are_exchanged_where_supports_hold_the_slaves" },
    ),
];

/// The numbers of all results of a run by quantity, and its iterations by step.
struct Outcome {
    quantities: BTreeMap<String, Vec<f64>>,
    iterations: Vec<usize>,
}

/// Runs a case as Kratos does, with one setting of an object changed.
fn run(case: &str, change: Option<(&str, &str, &Value)>) -> Outcome {
    let scratch = scratch_copy(&root().join("tests/cases").join(case));
    let path = scratch.path().join("ProjectParameters.json");
    let mut deck = read_json(&path).expect("a deck");
    if let Some((object, key, value)) = change {
        let lists = deck["processes"].as_object_mut().expect("processes").values_mut();
        let processes = lists.flat_map(|list| list.as_array_mut().expect("a list"));
        let own: Vec<_> = processes.filter(|process| process["python_module"] == *object).collect();
        assert!(!own.is_empty(), "{case} has no {object}");
        for process in own {
            let place = key.split('.').fold(&mut process["Parameters"], |place, key| &mut place[key]);
            *place = value.clone();
        }
    }
    std::fs::write(&path, deck.to_string()).expect("the changed deck");
    let before: BTreeSet<_> = files(scratch.path());
    let output =
        zelus(scratch.path(), &["run", "ProjectParameters.json", "--like", "kratos", "--report", "report.json"]);
    assert!(output.status.success(), "{case}: {}", said(&output));
    let report = read_json(&scratch.path().join("report.json")).expect("a report");
    let steps = report["steps"].as_array().expect("steps").iter();
    let iterations = steps.map(|step| step["iterations"].as_array().map_or(0, Vec::len)).collect();
    let mut quantities = BTreeMap::new();
    for file in files(scratch.path()).difference(&before).filter(|f| f.ends_with(".json") && *f != "report.json") {
        let results = read_json(&scratch.path().join(file)).expect("results");
        collect(file, &results, &mut quantities);
    }
    assert!(!quantities.is_empty(), "{case} writes no results");
    Outcome { quantities, iterations }
}

fn files(folder: &Path) -> BTreeSet<String> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
}

/// Numbers by the innermost key that is a name: the quantity, over nodes and steps.
fn collect(name: &str, value: &Value, out: &mut BTreeMap<String, Vec<f64>>) {
    match value {
        Value::Object(fields) => fields.iter().for_each(|(key, value)| {
            collect(if key.starts_with("NODE_") { name } else { key }, value, out);
        }),
        Value::Array(items) => items.iter().for_each(|item| collect(name, item, out)),
        _ => out.entry(name.to_owned()).or_default().extend(value.as_f64()),
    }
}

/// The largest change of a quantity, as a share of its largest value.
fn difference(a: &Outcome, b: &Outcome) -> f64 {
    let size = |values: &[f64]| values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let change = |(name, own): (&String, &Vec<f64>)| {
        let other = &b.quantities[name];
        if own.len() != other.len() {
            return f64::INFINITY;
        }
        let apart: Vec<f64> = own.iter().zip(other).map(|(a, b)| a - b).collect();
        if size(own) > 0.0 { size(&apart) / size(own) } else { size(&apart) }
    };
    a.quantities.iter().map(change).fold(0.0, f64::max)
}

/// The settings of an object, of this program or of Kratos, with dots; comments fall away.
fn settings(path: &str) -> BTreeMap<String, Value> {
    let text = std::fs::read_to_string(root().join(path)).unwrap_or_else(|e| panic!("{path}: {e}"));
    let plain: Vec<&str> = text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
    let root: Value = serde_json::from_str(&plain.join("\n")).unwrap_or_else(|e| panic!("{path}: {e}"));
    let mut flat = BTreeMap::new();
    flatten("", &root, &mut flat);
    flat
}

fn flatten(prefix: &str, value: &Value, out: &mut BTreeMap<String, Value>) {
    match value {
        Value::Object(fields) => {
            for (key, value) in fields {
                let key = if prefix.is_empty() { key.clone() } else { format!("{prefix}.{key}") };
                flatten(&key, value, out);
            }
        }
        _ => {
            out.insert(prefix.to_owned(), value.clone());
        }
    }
}

/// The table of the contact application and the files of settings say the same.
#[test]
fn every_setting_of_kratos_is_named_with_its_source() {
    let stated: BTreeSet<(String, String)> =
        DEVIATIONS.iter().flat_map(|d| d.of.iter().map(|of| ((*of).to_owned(), d.key.to_owned()))).collect();
    let mut laid = BTreeSet::new();
    for file in files(&root().join("configs/like_kratos")) {
        let object = file.trim_end_matches(".json").to_owned();
        if ["static", "dynamic", "explicit_dynamic"].contains(&object.as_str()) {
            continue;
        }
        let keys = settings(&format!("configs/like_kratos/{file}")).into_keys();
        laid.extend(keys.filter(|key| !key.ends_with(TOLERANCES)).map(|key| (object.clone(), key)));
    }
    assert_eq!(stated, laid);
    assert!(DEVIATIONS.iter().all(|d| !d.kratos.is_empty() && !d.here.is_empty() && !d.source.is_empty()));
}

#[test]
fn every_setting_of_kratos_changes_what_it_says() {
    let mut runs: BTreeMap<&str, Outcome> = BTreeMap::new();
    let mut problems = Vec::new();
    for (object, key, witness) in WITNESSES {
        assert!(DEVIATIONS.iter().any(|d| d.key == *key && d.of.contains(object)), "{object} {key} is no deviation");
        let (folder, changes) = match witness {
            Case { folder, changes } => (*folder, changes),
            Test { file, name } => {
                let text = std::fs::read_to_string(root().join("tests").join(file)).expect("a file of tests");
                assert!(text.contains(&format!("fn {name}()")), "{file} has no test {name}");
                continue;
            }
        };
        let default = settings(&format!("configs/processes/{object}.json"))[*key].clone();
        let kratos = settings(&format!("configs/like_kratos/{object}.json"))[*key].clone();
        assert_ne!(default, kratos, "{object}: \"{key}\" is that of Kratos");
        let as_kratos = runs.entry(folder).or_insert_with(|| run(folder, None));
        let switched = run(folder, Some((object, key, &json!(default))));
        let (apart, other_way) = (difference(as_kratos, &switched), as_kratos.iterations != switched.iterations);
        let holds = match changes {
            Iterations => other_way,
            Results(least) => apart >= *least,
        };
        if !holds {
            problems.push(format!("{object} {key} in {folder}: results change by {apart:e}, iterations: {other_way}"));
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}
