//! Contact behaviour that only imitates Kratos: every setting that `--like kratos` changes is named with its source, and switching it
//! changes the results that are stated here.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::support::{read_json, root, said, scratch_copy, zelus};
use serde_json::{Value, json};
use zelus::contact_structural_mechanics::kratos::DEVIATIONS;

/// Settings of contact in `configs/like_kratos` that are tolerances, whose default is another number for the same thing.
const TOLERANCES: &str = "_absolute_tolerance";

/// Proof that a setting matters.
enum Witness {
    /// A case that runs as Kratos does where `like` holds, else with the defaults; it changes with the other value of the setting.
    Case { folder: &'static str, like: bool, changes: Change },
    /// A test that switches it, by its file and name.
    Test { file: &'static str, name: &'static str },
}

use Change::{Iterations, Results};
use Witness::{Case, Test};

/// Effect of a setting.
enum Change {
    /// The numbers of iterations.
    Iterations,
    /// Results by at least this share of their largest value.
    Results(f64),
}

const ALM: &str = "alm_contact_process";
const PENALTY: &str = "penalty_contact_process";
const MPC: &str = "mpc_contact_process";
const MPC_SOLVER: &str = "mpc_contact_settings";
const SOLVER: &str = "contact_settings";
const WEIGHTED: &str = "advance_ALM_parameters.penalty_of_weighted_gaps";

const fn case(folder: &'static str, changes: Change) -> Witness {
    Case { folder, like: true, changes }
}

const WEIGHTS: Witness = Test { file: "contact/mpc.rs", name: "weights_by_facets_are_had_by_name" };
const SIDES: Witness = Test { file: "contact/mpc.rs", name: "sides_are_exchanged_where_supports_hold_the_slaves" };
const BESIDE: Witness = Test { file: "contact/like_kratos.rs", name: "nodes_beside_the_master_bear_nothing" };
const MARGIN: Witness = Test { file: "contact/like_kratos.rs", name: "nodes_within_a_margin_slide_on" };
const ENERGY: Witness = Test { file: "steps/impact.rs", name: "energy_that_a_coarse_slave_makes_is_accepted_by_name" };
const DEPTH: Witness =
    Test { file: "program/soundness.rs", name: "soft_penalties_are_refused_beyond_a_share_of_the_mesh" };
const IMPACTS: Witness = Test { file: "steps/impact.rs", name: "without_redistribution_energy_grows" };

const WITNESSES: &[(&str, &str, Witness)] = &[
    (ALM, "normal_variation", case("contact_2d/hertz_spheres_light_coarse", Results(1e-6))),
    (ALM, "augmentation", case("contact_2d/hertz_spheres_light", Results(1e-7))),
    (ALM, "nodal_normals", case("contact_2d/hertz_spheres_light", Results(3e-8))),
    (ALM, "mind_supports", case("contact_2d/hertz_spheres_light_coarse", Results(1e-7))),
    (ALM, "count_slivers", case("contact_2d/friction_slide_millimetres", Results(1e-7))),
    (ALM, "search_parameters.search_distance", case("contact_2d/dropped_deep", Iterations)),
    (ALM, "search_parameters.search_within_step", case("contact_2d/dropped_deep", Iterations)),
    (ALM, "search_parameters.set_at_start", case("contact_2d/hertz_spheres_light", Iterations)),
    (ALM, "slip_step_reset_frequency", case("contact_2d/friction_slide", Iterations)),
    (ALM, "absolute_operator_threshold", case("contact_2d/friction_slide_millimetres", Results(1e-7))),
    (ALM, "sliding_direction", case("contact_2d/friction_slide", Results(1e-6))),
    (ALM, "slip_threshold", MARGIN),
    (ALM, "least_coverage", BESIDE),
    (ALM, "operator_threshold", Case { folder: "contact_2d/cattaneo_mindlin", like: false, changes: Results(1e-3) }),
    (PENALTY, "count_slivers", case("contact_2d/friction_penalty_slide", Results(1e-7))),
    (PENALTY, "tangent_factor", case("contact_2d/friction_penalty_stick", Results(1e-3))),
    (PENALTY, WEIGHTED, case("contact_2d/friction_penalty_stick", Results(1e-3))),
    ("explicit_penalty_contact_process", WEIGHTED, case("contact_3d/explicit_touch", Results(1e-4))),
    (MPC, "consistent_weights", WEIGHTS),
    (MPC, "keep_first_opening", WEIGHTS),
    (MPC, "update_condition_relation_step", case("mpc/pressed_and_opened", Results(1e-2))),
    (MPC, "swap_held_slaves", SIDES),
    (SOLVER, "contact_stabilisation", IMPACTS),
    (SOLVER, "impact_energy_tolerance", IMPACTS),
    (SOLVER, "largest_energy_gain", ENERGY),
    (SOLVER, "largest_penetration", DEPTH),
    (SOLVER, "edge_normals", Case { folder: "contact_3d/skin_detection", like: false, changes: Results(1e-2) }),
    (MPC_SOLVER, "update_each_nl_iteration", case("mpc/pressed_and_opened", Results(1e-2))),
];

/// The numbers of all results of a run by quantity, and its iterations by step.
struct KratosOutcome {
    quantities: BTreeMap<String, Vec<f64>>,
    iterations: Vec<usize>,
}

/// Gives all objects of this name in a deck another setting.
fn set(deck: &mut Value, object: &str, key: &str, value: &Value) {
    if object.ends_with("_settings") {
        deck["solver_settings"][object][key] = value.clone();
        return;
    }
    let lists = deck["processes"].as_object_mut().expect("processes").values_mut();
    let processes = lists.flat_map(|list| list.as_array_mut().expect("a list"));
    let own: Vec<_> = processes.filter(|process| process["python_module"] == *object).collect();
    assert!(!own.is_empty(), "the deck has no {object}");
    for process in own {
        let place = key.split('.').fold(&mut process["Parameters"], |place, key| &mut place[key]);
        *place = value.clone();
    }
}

/// Runs a case that is edited first, as Kratos does where `like` holds.
fn run(case: &str, like: bool, edit: impl Fn(&mut Value)) -> KratosOutcome {
    let scratch = scratch_copy(&root().join("tests/cases").join(case));
    let path = scratch.path().join("ProjectParameters.json");
    let mut deck = read_json(&path).expect("a deck");
    edit(&mut deck);
    std::fs::write(&path, deck.to_string()).expect("the changed deck");
    let before: BTreeSet<_> = files(scratch.path());
    let mut words = vec!["run", "ProjectParameters.json", "--report", "report.json"];
    words.extend(if like { &["--like", "kratos"][..] } else { &[] });
    let output = zelus(scratch.path(), &words);
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
    KratosOutcome { quantities, iterations }
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
fn difference(a: &KratosOutcome, b: &KratosOutcome) -> f64 {
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
        let others = [
            "static",
            "dynamic",
            "explicit_dynamic",
            "explicit_transient",
            "stationary",
            "coupling_settings",
            "transient",
            "vtk_output_process",
            "vtu_output_process",
        ];
        if others.contains(&object.as_str()) {
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
    let mut runs: BTreeMap<(&str, bool), KratosOutcome> = BTreeMap::new();
    let mut problems = Vec::new();
    for (object, key, witness) in WITNESSES {
        assert!(DEVIATIONS.iter().any(|d| d.key == *key && d.of.contains(object)), "{object} {key} is no deviation");
        let (folder, like, changes) = match witness {
            Case { folder, like, changes } => (*folder, *like, changes),
            Test { file, name } => {
                let text = std::fs::read_to_string(root().join("tests").join(file)).expect("a file of tests");
                assert!(text.contains(&format!("fn {name}()")), "{file} has no test {name}");
                continue;
            }
        };
        let kind = if object.ends_with("_settings") { "solvers" } else { "processes" };
        let default = settings(&format!("configs/{kind}/{object}.json"))[*key].clone();
        let kratos = settings(&format!("configs/like_kratos/{object}.json"))[*key].clone();
        assert_ne!(default, kratos, "{object}: \"{key}\" is that of Kratos");
        let plain = runs.entry((folder, like)).or_insert_with(|| run(folder, like, |_| {}));
        let other = if like { default } else { kratos };
        let switched = run(folder, like, |deck| set(deck, object, key, &json!(other)));
        let (apart, other_way) = (difference(plain, &switched), plain.iterations != switched.iterations);
        let holds = match changes {
            Iterations => other_way,
            Results(least) => apart >= *least,
        };
        if !holds {
            problems.push(format!("{object} {key} in {folder}: results change by {apart:e}, iterations: {other_way}"));
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
    let keys: BTreeSet<&str> = DEVIATIONS.iter().map(|d| d.key).collect();
    assert_eq!(keys, WITNESSES.iter().map(|(_, key, _)| *key).collect::<BTreeSet<_>>());
}

/// A block goes beyond the end of its ground, which then covers a twelfth of the last but one facet.
#[test]
fn nodes_beside_the_master_bear_nothing() {
    let outcome = |least: f64| {
        run("contact_2d/slid_past", false, |deck| {
            *deck = serde_json::from_str(&deck.to_string().replace("2.0*(t-1.0)", "2.73*(t-1.0)")).expect("a deck");
            set(deck, ALM, "least_coverage", &json!(least));
        })
    };
    let (ours, kratos) = (outcome(0.1), outcome(0.0));
    let apart = difference(&ours, &kratos);
    assert!(apart > 1e-3, "results change by {apart:e}");
}

/// Where all near nodes begin a step in contact, some turn back on the way to its end.
#[test]
fn nodes_within_a_margin_slide_on() {
    let outcome = |margin: f64| {
        run("contact_2d/cattaneo_mindlin_light_coarse", false, |deck| {
            set(deck, ALM, "search_parameters.set_at_start", &json!("near"));
            set(deck, ALM, "slip_threshold", &json!(margin));
        })
    };
    assert_ne!(outcome(0.0).iterations, outcome(2e-2).iterations);
}

/// ANALYTIC: a converged state does not depend on the set with which its step begins; friction, whose states depend on their past, agrees
/// to the tolerances of the deck, 1e-6 of the largest value.
#[test]
fn steps_that_begin_with_the_last_set_reach_the_same_state_in_fewer_iterations() {
    let outcome = |start: &str| {
        run("contact_2d/cattaneo_mindlin_light", false, |deck| {
            set(deck, ALM, "search_parameters.set_at_start", &json!(start));
        })
    };
    let (kept, near) = (outcome("kept"), outcome("near"));
    let apart = difference(&kept, &near);
    assert!(apart < 1e-6, "results change by {apart:e}");
    let [kept, near] = [kept, near].map(|outcome| outcome.iterations.iter().sum::<usize>());
    assert!(5 * kept < 4 * near, "{kept} and {near} iterations");
}
