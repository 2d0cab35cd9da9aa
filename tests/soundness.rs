//! Whether a model can have the answer that is asked for: bodies inside each other, states that no contact can be in.

mod support;

use std::path::Path;

use serde_json::{Value, json};
use support::{change, read_json, root, said, scratch_copy, zelus};

const DECK: &str = "ProjectParameters.json";

/// A case whose deck is changed.
fn case(name: &str, edit: impl FnOnce(&mut Value)) -> tempfile::TempDir {
    let scratch = scratch_copy(&root().join("tests/cases").join(name));
    let path = scratch.path().join(DECK);
    let mut deck = read_json(&path).expect("the deck");
    edit(&mut deck);
    std::fs::write(path, deck.to_string()).expect("the deck");
    scratch
}

fn run(folder: &Path, command: &str) -> (Option<i32>, String) {
    let mut words = vec![command, DECK];
    words.extend(if command == "run" { &["--report", "report.json"][..] } else { &[] });
    let output = zelus(folder, &words);
    (output.status.code(), said(&output).split_whitespace().collect::<Vec<_>>().join(" "))
}

/// The upper block of a stack, which is held at its top, begins inside the lower one by `depth`.
fn sunk(depth: f64, edit: impl FnOnce(&mut Value)) -> tempfile::TempDir {
    let scratch = case("contact_2d/nonmatching", |deck| {
        deck["processes"]["loads_process_list"] = json!([]);
        let supports = deck["processes"]["constraints_process_list"].as_array_mut().expect("a list");
        let mut top = supports[0].clone();
        top["Parameters"]["model_part_name"] = json!("Structure.Top");
        supports.push(top);
        edit(deck);
    });
    let path = scratch.path().join("mesh.mdpa");
    let text = std::fs::read_to_string(&path).expect("the mesh");
    let nodes = text.split("Begin Nodes").nth(1).and_then(|rest| rest.split("End Nodes").next()).expect("nodes");
    let upper = nodes.lines().filter(|line| !line.trim().is_empty()).skip_while(|line| {
        // The last node of the lower block lies at its top right corner.
        let numbers: Vec<f64> = line.split_whitespace().map(|word| word.parse().expect("a number")).collect();
        !(numbers[1] == 1.0 && numbers[2] == 1.0)
    });
    let moved: Vec<String> = upper
        .skip(1)
        .map(|line| {
            let numbers: Vec<&str> = line.split_whitespace().collect();
            let y: f64 = numbers[2].parse().expect("a number");
            change(
                scratch.path(),
                "mesh.mdpa",
                &format!("\n{line}\n"),
                &format!("\n{} {} {} 0\n", numbers[0], numbers[1], y - depth),
            );
            numbers[0].to_owned()
        })
        .collect();
    assert!(moved.len() > 3, "{moved:?}");
    scratch
}

#[test]
fn bodies_that_begin_inside_each_other_are_named() {
    let scratch = sunk(0.03, |_| {});
    for command in ["check", "run"] {
        let (code, said) = run(scratch.path(), command);
        assert_eq!(code, Some(0), "{command}: {said}");
        assert!(said.contains("warning[initial-penetration]"), "{command}: {said}");
        assert!(said.contains("0: Slave on Interface: 6 slave nodes") && said.contains("by 3.000e-2"), "{said}");
        assert!(said.contains("\"adjust_initial\": true"), "{said}");
    }
    // By most of the body.
    let (_, said) = run(sunk(0.9, |_| {}).path(), "check");
    assert!(said.contains("[initial-penetration]") && said.contains("move the bodies apart"), "{said}");
}

#[test]
fn adjusted_nodes_begin_on_the_master_without_strain() {
    for depth in [0.005, -0.005] {
        let scratch = sunk(depth, |deck| deck["solver_settings"]["contact_settings"]["adjust_initial"] = json!(true));
        let (code, said) = run(scratch.path(), "run");
        assert_eq!(code, Some(0), "{said}");
        assert!(said.contains("note[adjusted-initial]") && said.contains("moved onto it without strain"), "{said}");
        assert!(!said.contains("initial-penetration"), "{said}");
        let report = read_json(&scratch.path().join("report.json")).expect("a report");
        let balance = &report["steps"][0]["balance"];
        let force = balance["pairs"][0]["force"][1].as_f64().expect("a force");
        let stored = balance["energies"]["stored"].as_f64().expect("an energy");
        assert!(force.abs() < 1e-3 && stored.abs() < 1e-9, "{depth}: force {force:e}, energy {stored:e}");
    }
    // Without it the same state is stressed by E times the strain.
    let scratch = sunk(0.005, |_| {});
    run(scratch.path(), "run");
    let report = read_json(&scratch.path().join("report.json")).expect("a report");
    let force = report["steps"][0]["balance"]["pairs"][0]["force"][1].as_f64().expect("a force");
    assert!(force.abs() > 1e5, "{force:e}");
}

#[test]
fn soft_penalties_are_refused_beyond_a_share_of_the_mesh() {
    let soft = |most: f64| {
        case("contact_2d/matching", |deck| {
            deck["solver_settings"]["contact_settings"]["mortar_type"] = json!("PenaltyContactFrictionless");
            deck["solver_settings"]["contact_settings"]["largest_penetration"] = json!(most);
            let process = &mut deck["processes"]["contact_process_list"][0];
            process["python_module"] = json!("penalty_contact_process");
            process["Parameters"]["advance_ALM_parameters"] = json!({"manual_ALM": true, "penalty": 1e7});
        })
    };
    let (code, said) = run(soft(0.2).path(), "run");
    assert_eq!(code, Some(3), "{said}");
    for words in ["inside the master by more than 0.2 of their mesh size", "raise the penalty", "largest_penetration"] {
        assert!(said.contains(words), "{said}");
    }
    let (code, said) = run(soft(0.0).path(), "run");
    assert_eq!(code, Some(0), "{said}");
}
