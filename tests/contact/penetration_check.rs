//! Bodies that do not meet, or that penetrate each other undetected by contact: no wrong result ends with exit 0, and pairs never in
//! contact are reported at the end.

use std::path::Path;

use crate::blocks_of_case::raised;
use crate::support::{read_json, root, said, scratch_copy, zelus};
use serde_json::{Value, json};

const DECK: &str = "ProjectParameters.json";

/// Two blocks of this height, a gap between them, the upper one moved by its top; `change` has the last word.
fn blocks(height: f64, gap: f64, motion: f64, change: impl FnOnce(&mut Value)) -> tempfile::TempDir {
    let scratch = scratch_copy(&root().join("tests/cases/contact_2d/matching"));
    let mesh = scratch.path().join("mesh.mdpa");
    let text = std::fs::read_to_string(&mesh).expect("the mesh");
    std::fs::write(&mesh, raised(&text, height, gap)).expect("a file");
    let mut deck = read_json(&scratch.path().join(DECK)).expect("the deck");
    deck["problem_data"]["end_time"] = json!(1.0);
    let processes = deck["processes"].as_object_mut().expect("lists");
    processes.remove("json_output_process_list");
    processes.remove("loads_process_list");
    let supports = processes["constraints_process_list"].as_array_mut().expect("a list");
    let mut top = supports[0].clone();
    top["Parameters"]["model_part_name"] = json!("Structure.Top");
    top["Parameters"]["value"] = json!([null, format!("{motion}*t"), null]);
    supports.push(top);
    change(&mut deck);
    std::fs::write(scratch.path().join(DECK), deck.to_string()).expect("a file");
    scratch
}

fn step(deck: &mut Value, length: f64) {
    deck["solver_settings"]["time_stepping"]["time_step"] = json!(length);
}

fn go(folder: &Path) -> (Option<i32>, String) {
    let output = zelus(folder, &["run", DECK, "--report", "run.json"]);
    (output.status.code(), said(&output))
}

/// Open slave nodes of the last step.
fn open(folder: &Path) -> u64 {
    let report = read_json(&folder.join("run.json")).expect("the report");
    let steps = report["steps"].as_array().expect("steps");
    steps.last().expect("a step")["balance"]["pairs"][0]["open"].as_u64().expect("a count")
}

#[test]
fn pairs_that_never_meet_are_named_at_the_end() {
    let scratch = blocks(1.0, 25.0, -0.5, |deck| step(deck, 0.5));
    let (status, said) = go(scratch.path());
    assert_eq!(status, Some(0), "{said}");
    let fact = "warning[never-met]: contact pair 0: Slave on Interface never met in 2 steps";
    assert!(said.contains(fact) && said.contains("2.450e1 apart at the end"), "{said}");
    // Of the pairs that meet, in one step or in all, nothing is said.
    for motion in [-0.3, -0.11] {
        let scratch = blocks(1.0, 0.1, motion, |deck| step(deck, 0.5));
        let (status, said) = go(scratch.path());
        assert!(status == Some(0) && !said.contains("never-met"), "{said}");
    }
}

#[test]
fn contact_by_constraints_that_never_meets_is_named() {
    let scratch = blocks(1.0, 25.0, -0.5, |deck| {
        step(deck, 0.5);
        let solver = deck["solver_settings"].as_object_mut().expect("settings");
        solver.remove("contact_settings");
        solver.insert("convergence_criterion".to_owned(), json!("residual_criterion"));
        solver.insert("mpc_contact_settings".to_owned(), json!({"contact_type": "Frictionless"}));
        deck["processes"]["contact_process_list"][0]["python_module"] = json!("mpc_contact_process");
    });
    let (status, said) = go(scratch.path());
    assert!(status == Some(0) && said.contains("warning[never-met]"), "{said}");
}

#[test]
fn bodies_pressed_into_each_other_by_other_faces_than_the_named_ones_are_refused() {
    let scratch = blocks(1.0, 0.1, -0.9, |deck| {
        step(deck, 0.25);
        let contact = &mut deck["processes"]["contact_process_list"][0]["Parameters"];
        // The top of the upper block in place of its bottom.
        contact["contact_model_part"] = json!({"0": ["Lower", "Top"]});
        contact["assume_master_slave"] = json!({"0": ["Top"]});
    });
    let (status, said) = go(scratch.path());
    assert_eq!(status, Some(3), "{said}");
    let words = ["inside a body by more than 0.2 of their mesh size", "the first is node", "contact_model_part"];
    assert!(words.iter().all(|word| said.contains(word)), "{said}");
}

#[test]
fn bodies_that_begin_inside_each_other_are_refused() {
    let scratch = blocks(1.0, -0.8, -0.01, |deck| step(deck, 1.0));
    let (status, said) = go(scratch.path());
    assert!(status == Some(2) && said.contains("error[initial-penetration]"), "{said}");
    let scratch = blocks(1.0, -0.8, -0.01, |deck| {
        step(deck, 1.0);
        deck["solver_settings"]["contact_settings"]["largest_penetration"] = json!(0.0);
    });
    let (status, said) = go(scratch.path());
    assert!(status == Some(0) && said.contains("warning[initial-penetration]"), "{said}");
}

/// One step takes the upper block from far before the lower one to far behind it.
#[test]
fn bodies_do_not_pass_each_other_within_a_step() {
    for height in [1.0, 0.1] {
        for motion in [-5.0, -20.0] {
            let scratch = blocks(height, 2.0, motion, |deck| step(deck, 1.0));
            let (status, said) = go(scratch.path());
            assert!(said.contains("slave nodes go through the master within the step"), "{height} {motion}: {said}");
            let passed = status == Some(0) && open(scratch.path()) > 0;
            assert!(!passed, "{height} {motion}: {said}");
        }
    }
}
