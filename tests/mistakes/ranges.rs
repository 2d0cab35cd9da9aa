//! Numbers outside the range of their key or material, and words that stand for no number: named before a run.

use std::collections::BTreeSet;

use serde_json::{Value, json};
use zelus as _;
use zelus_core::parameters::Defaults;
use zelus_core::registry;

use crate::support::{read_json, root, said, scratch_copy, zelus};
use crate::table::{PRESSED, SLIDING, contact, load};
use crate::{DECK, MATERIALS};

/// Exit code and messages of a command on a case whose deck or materials are changed.
fn told(case: &str, file: &str, command: &[&str], edit: &dyn Fn(&mut Value)) -> (Option<i32>, String) {
    let scratch = scratch_copy(&root().join("tests/cases").join(case));
    let path = scratch.path().join(file);
    let mut json = read_json(&path).expect("JSON");
    edit(&mut json);
    std::fs::write(&path, serde_json::to_string_pretty(&json).expect("JSON")).expect("a file");
    let output = zelus(scratch.path(), command);
    (output.status.code(), said(&output))
}

#[test]
fn every_number_has_a_range_that_holds_its_default() {
    let mut ranged = BTreeSet::new();
    for (_, entry) in registry::entries().into_iter().filter(|(_, entry)| !entry.defaults.is_empty()) {
        let defaults = Defaults::parse(entry.name, entry.defaults).expect("defaults");
        let is_idle = |path: &str| {
            let idle = defaults.entries().iter().filter(|key| key.without_effect.is_some());
            idle.into_iter()
                .any(|key| path.strip_prefix(&*key.path).is_some_and(|rest| rest.is_empty() || rest.starts_with('.')))
        };
        for key in defaults.entries() {
            let Some(range) = key.range else {
                let is_number = ["a number", "an integer"].contains(&key.kind) && !is_idle(&key.path);
                assert!(
                    !is_number,
                    "{}.{} needs a range under \"$ranges\", at least (-inf, inf)",
                    entry.name, key.path
                );
                continue;
            };
            let default: f64 = key.default.parse().expect("a key with a range is a number");
            assert!(range.holds(default), "{}.{} is {default}, it must be {range}", entry.name, key.path);
            ranged.insert(key.path.clone());
        }
    }
    assert!(ranged.len() > 100, "{ranged:?}");
}

#[test]
fn gaps_of_an_adapted_penalty_in_the_other_order_are_refused() {
    for (adapts, code) in [(true, Some(2)), (false, Some(0))] {
        let (found, said) = told(PRESSED, DECK, &["check", DECK], &|deck| {
            deck["solver_settings"]["contact_settings"]["mortar_type"] = json!("PenaltyContactFrictionless");
            deck["processes"]["contact_process_list"][0]["python_module"] = json!("penalty_contact_process");
            contact(deck)["advance_ALM_parameters"] = json!({"adapt_penalty": adapts, "adaptation_rule": "APM", "min_gap_factor": 1e-2, "max_gap_factor": 1e-3});
        });
        assert_eq!(found, code, "{said}");
        assert_eq!(said.contains("error[out-of-range]") && said.contains("min_gap_factor"), adapts, "{said}");
    }
}

#[test]
fn settings_out_of_range_are_refused() {
    for (key, value) in [
        ("zero_tolerance_factor", 0.0),
        ("zero_tolerance_factor", -1.0),
        ("tangent_factor", -1.0),
        ("least_coverage", -0.1),
        ("least_coverage", 1.5),
        ("slip_threshold", -1e-3),
    ] {
        let (code, said) = told(PRESSED, DECK, &["check", DECK], &|deck| contact(deck)[key] = json!(value));
        assert!(code == Some(2) && said.contains("error[out-of-range]") && said.contains(key), "{key} {value}: {said}");
    }
    for (key, value) in [("penalty", -1.0), ("scale_factor", 0.0), ("stiffness_factor", -2.0), ("max_gap_factor", 0.0)]
    {
        let (code, said) = told(PRESSED, DECK, &["run", DECK], &|deck| {
            contact(deck)["advance_ALM_parameters"] = json!({ key: value })
        });
        assert!(code == Some(2) && said.contains("error[out-of-range]") && said.contains(key), "{key} {value}: {said}");
    }
}

#[test]
fn materials_out_of_range_are_refused() {
    for (name, value) in [("DENSITY", -1.0), ("THICKNESS", 0.0)] {
        let (code, said) = told(PRESSED, MATERIALS, &["check", DECK], &|materials| {
            materials["properties"][0]["Material"]["Variables"][name] = json!(value);
        });
        assert!(code == Some(2) && said.contains("error[material-out-of-range]") && said.contains(name), "{said}");
    }
}

#[test]
fn a_decimal_comma_is_refused() {
    let (code, said) = told(PRESSED, DECK, &["check", DECK], &|deck| load(deck)["modulus"] = json!("1,0e6*t"));
    assert!(code == Some(2) && said.contains("write 1.5 for 1,5"), "{said}");
}

#[test]
fn a_step_longer_than_the_run_ends_with_it() {
    let edit = |deck: &mut Value| {
        deck["solver_settings"]["time_stepping"] = json!({ "time_step": 10.0 });
        deck["problem_data"]["end_time"] = json!(1.0);
    };
    let (code, said) = told(PRESSED, DECK, &["run", DECK], &edit);
    assert!(code == Some(0) && said.contains("warning[time-step]") && said.contains("time 1.000000"), "{said}");
}

#[test]
fn a_key_of_the_command_line_that_nothing_reads_is_an_error() {
    let command = ["run", DECK, "--set", "solver_settings.max_iterations=20"];
    let (code, said) = told(PRESSED, DECK, &command, &|_| {});
    assert!(code == Some(2) && said.contains("max_iterations") && said.contains("max_iteration"), "{said}");
}

#[test]
fn one_pair_without_friction_is_named() {
    let (code, said) = told(SLIDING, DECK, &["check", DECK], &|deck| {
        let own = contact(deck);
        own["contact_model_part"]["1"] = own["contact_model_part"]["0"].clone();
        own["assume_master_slave"]["1"] = own["assume_master_slave"]["0"].clone();
        own["friction_coefficients"] = json!({ "0": 0.3 });
    });
    assert!(code == Some(0) && said.contains("warning[no-friction]") && said.contains("in pair \"1\""), "{said}");
}

#[test]
fn a_tie_of_what_is_no_unknown_is_refused() {
    for name in ["TEMPERATURE", "VELOCITY", "REACTION"] {
        let (code, said) = told("mesh_tying/quadrilaterals", DECK, &["run", DECK], &|deck| {
            let lists = deck["processes"].as_object_mut().expect("lists of processes");
            let all = lists.values_mut().filter_map(Value::as_array_mut).flatten();
            let tie = all.into_iter().find(|process| process["python_module"] == "mesh_tying_process");
            tie.expect("a tie")["Parameters"]["variable_name"] = json!(name);
        });
        assert!(code == Some(2) && said.contains("tied-variable") && said.contains(name), "{name}: {said}");
    }
}

#[test]
fn a_thousand_threads_are_the_most() {
    let (code, said) = told(PRESSED, DECK, &["run", DECK, "--threads", "5000"], &|_| {});
    assert!(code == Some(2) && said.contains("error[threads]"), "{said}");
}
