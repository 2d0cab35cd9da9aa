//! Whether a model can have the answer that is asked for: bodies inside each other, states that no contact can be in.

use std::path::Path;

use crate::support::{change, read_json, root, said, scratch_copy, zelus};
use crate::thread_ranks::on_threads;
use serde_json::{Value, json};
use zelus::core::communication::Ranks;
use zelus::core::diagnostics::Diagnostic;
use zelus::{Monitor, RunOptions, Simulation};

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
        assert!(
            said.contains("note[adjusted-initial]") && said.contains("moved onto the master without strain"),
            "{said}"
        );
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

/// Lists the first entity of a block once more under another id, with its nodes going round from another one, also in a part.
fn list_again(folder: &Path, block: &str, id: usize, part: &str, list: &str) {
    let path = folder.join("mesh.mdpa");
    let mesh = std::fs::read_to_string(&path).expect("the mesh");
    let mut lines: Vec<String> = mesh.lines().map(str::to_owned).collect();
    let header = lines.iter().position(|line| line.starts_with(block)).expect("the block");
    let words: Vec<String> = lines[header + 1].split_whitespace().map(str::to_owned).collect();
    let mut nodes = words[2..].to_vec();
    nodes.rotate_left(1);
    lines.insert(header + 1, format!("{id} {} {}", words[1], nodes.join(" ")));
    let part = lines.iter().position(|line| line.trim() == format!("Begin SubModelPart {part}")).expect("the part");
    let list = part + lines[part..].iter().position(|line| line.trim() == format!("Begin {list}")).expect("a list");
    lines.insert(list + 1, id.to_string());
    std::fs::write(path, lines.join("\n")).expect("the mesh");
}

#[test]
fn entities_listed_twice_are_named() {
    let scratch = case("contact_2d/matching", |_| {});
    list_again(scratch.path(), "Begin Elements", 901, "Lower", "SubModelPartElements");
    let (code, said) = run(scratch.path(), "check");
    assert_eq!(code, Some(0), "{said}");
    let words = ["warning[listed-twice]", "1 element has the nodes of others", " 901 with those of 1:", "counts twice"];
    words.iter().for_each(|words| assert!(said.contains(words), "{words}: {said}"));

    let scratch = case("contact_2d/matching", |_| {});
    list_again(scratch.path(), "Begin Conditions LineLoad", 902, "Top", "SubModelPartConditions");
    let (_, said) = run(scratch.path(), "check");
    assert!(said.contains("warning[listed-twice]") && said.contains("902 with those of"), "{said}");
}

#[test]
fn two_values_of_one_unknown_are_named() {
    let scratch = case("contact_2d/matching", |deck| {
        let supports = deck["processes"]["constraints_process_list"].as_array_mut().expect("a list");
        let mut other = supports[0].clone();
        other["Parameters"]["value"] = json!([null, "0.001*t", null]);
        supports.push(other);
    });
    let (code, said) = run(scratch.path(), "check");
    assert_eq!(code, Some(0), "{said}");
    let words = ["warning[contradicting-values]", "DISPLACEMENT_Y", "the first is node 1: 0 by", "which wins"];
    words.iter().for_each(|words| assert!(said.contains(words), "{words}: {said}"));
}

#[test]
fn what_holds_a_body_is_said_before_the_run() {
    let without = |name: &'static str, keep: usize| {
        case(name, move |deck| {
            deck["processes"]["constraints_process_list"].as_array_mut().expect("a list").truncate(keep);
        })
    };
    // The upper block lies on the lower one; both are guided across.
    let (_, said) = run(case("contact_2d/matching", |_| {}).path(), "check");
    assert!(said.contains("[held-by-contact]") && said.contains("part Upper"), "{said}");
    assert!(!said.contains("held-by-nothing") && !said.contains("part Lower"), "{said}");
    // Without its guides nothing keeps it from sliding, and the lower one with it.
    let (code, said) = run(without("contact_2d/matching", 1).path(), "check");
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("warning[held-by-nothing]") && said.contains("support it in all directions"), "{said}");
    // With friction it is that.
    let (_, said) = run(without("contact_2d/friction_slide", 1).path(), "check");
    assert!(said.contains("note[held-by-friction]") && said.contains("part Upper"), "{said}");
    // A body without contact, which the solver finds, too, and says where it is.
    let (_, said) = run(without("structural/self_weight", 0).path(), "check");
    assert!(said.contains("warning[held-by-nothing]") && said.contains("6 rigid-body modes"), "{said}");
    let (code, said) = run(without("structural/self_weight", 0).path(), "run");
    assert_eq!(code, Some(4), "{said}");
    assert!(said.contains("; what moves is at node ") && said.contains(" of part Body"), "{said}");
}

/// Loads that follow each other, or are others, do not take each other's place.
#[test]
fn loads_that_do_not_meet_are_silent() {
    let with = |change: fn(&mut Value)| {
        case("contact_2d/matching", |deck| {
            let loads = deck["processes"]["loads_process_list"].as_array_mut().expect("a list");
            loads[0]["Parameters"]["interval"] = json!([0.0, 0.5]);
            let mut other = loads[0].clone();
            change(&mut other);
            loads.push(other);
        })
    };
    let later = with(|load| load["Parameters"]["interval"] = json!([0.5, "End"]));
    let pressure = with(|load| {
        load["python_module"] = json!("assign_scalar_variable_to_conditions_process");
        let part = json!({"model_part_name": "Structure.Top", "variable_name": "POSITIVE_FACE_PRESSURE", "value": 1.0});
        load["Parameters"] = part;
    });
    for scratch in [later, pressure] {
        let (code, said) = run(scratch.path(), "check");
        assert!(code == Some(0) && !said.contains("load-given-twice"), "{said}");
    }
}

#[test]
fn loads_without_area_are_named() {
    let scratch = case("contact_2d/matching", |_| {});
    change(scratch.path(), "mesh.mdpa", "\n7 0 22 21\n", "\n7 0 22 22\n");
    let (code, said) = run(scratch.path(), "check");
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("LineLoadCondition2D2N 7") && said.contains("it has no size"), "{said}");
}

#[test]
fn facets_without_area_are_named() {
    let scratch = case("contact_2d/matching", |_| {});
    change(scratch.path(), "mesh.mdpa", "\n14 0.333333333333 1 0\n", "\n14 0 1 0\n");
    let (code, said) = run(scratch.path(), "check");
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("error[degenerate-facet]")
            && said.contains("condition 4 on element 7 has no area: its nodes are 13, 14"),
        "{said}"
    );
}

/// Several ranks report the same restraint of a body as one.
#[test]
fn ranks_together_say_what_holds_a_body() {
    for (name, keep) in [
        ("contact_2d/matching", 3),
        ("contact_2d/matching", 1),
        ("contact_3d/friction_slide", 1),
        ("structural/self_weight", 0),
    ] {
        let scratch = case(name, move |deck| {
            deck["processes"]["constraints_process_list"].as_array_mut().expect("a list").truncate(keep);
        });
        let heard = |ranks: Ranks| {
            let options = RunOptions { threads: Some(1), ranks, ..RunOptions::default() };
            let mut simulation = Simulation::open(&scratch.path().join(DECK), &options).expect("a deck");
            let mut heard = Held::default();
            simulation.check(&mut heard).expect("no errors");
            heard.0
        };
        let alone = heard(Ranks::default());
        assert!(!alone.is_empty(), "{name}");
        for count in [2, 3] {
            assert!(on_threads(count, heard).contains(&alone), "{name} on {count} ranks, not {alone:?}");
        }
    }
}

/// Collects the notes on restraint of bodies.
#[derive(Default)]
struct Held(Vec<String>);

impl Monitor for Held {
    fn warn(&mut self, warning: &Diagnostic) {
        let said = warning.to_string();
        if said.contains("held-by-") {
            self.0.push(said);
        }
    }
}

#[test]
fn whole_bodies_as_contact_parts_are_named() {
    let scratch = case("contact_2d/matching", |deck| {
        let process = &mut deck["processes"]["contact_process_list"][0]["Parameters"];
        process["contact_model_part"] = json!({"0": ["Lower", "Upper"]});
        process["assume_master_slave"] = json!({"0": ["Upper"]});
    });
    let (_, said) = run(scratch.path(), "check");
    assert!(said.contains("warning[whole-body]") && said.contains("\"Upper\""), "{said}");
}

#[test]
fn a_step_that_fails_says_where_and_leaves_its_last_iterate() {
    let scratch = case("contact_2d/matching", |deck| {
        deck["solver_settings"]["max_iteration"] = json!(1);
        deck["solver_settings"]["contact_settings"]["adaptative_strategy"] = json!(true);
        deck["solver_settings"]["contact_settings"]["max_number_splits"] = json!(0);
        // It pulls: all nodes leave contact.
        deck["processes"]["loads_process_list"][0]["Parameters"]["modulus"] = json!(-1e6);
        let vtu = json!({"python_module": "vtu_output_process", "kratos_module": "KratosMultiphysics", "Parameters": {
            "model_part_name": "Structure", "output_path": "pictures",
            "nodal_solution_step_data_variables": ["DISPLACEMENT"]
        }});
        deck["output_processes"] = json!({"pictures": [vtu]});
    });
    let (code, said) = run(scratch.path(), "run");
    assert_eq!(code, Some(3), "{said}");
    for words in ["largest residual", " at (", " of part ", "still changes: node", "its last iterate, no result, is in"]
    {
        assert!(said.contains(words), "{words}: {said}");
    }
    let pictures = |folder: &str| {
        let entries = std::fs::read_dir(scratch.path().join(folder)).into_iter().flatten().flatten();
        entries.filter(|entry| entry.path().extension().is_some_and(|ending| ending == "vtu")).count()
    };
    assert_eq!((pictures("pictures"), pictures("pictures_last_iterate")), (0, 1));
    // A run that gets on leaves none.
    let path = scratch.path().join(DECK);
    let mut deck = read_json(&path).expect("the deck");
    deck["solver_settings"]["max_iteration"] = json!(30);
    deck["processes"]["loads_process_list"][0]["Parameters"]["modulus"] = json!(1e6);
    std::fs::write(path, deck.to_string()).expect("the deck");
    let (code, said) = run(scratch.path(), "run");
    assert_eq!(code, Some(0), "{said}");
    assert!(pictures("pictures") > 0 && pictures("pictures_last_iterate") == 0);
}

#[test]
fn elements_that_turn_inside_out_are_named_with_their_places() {
    let scratch = case("contact_2d/matching", |deck| {
        deck["solver_settings"]["contact_settings"]["adaptative_strategy"] = json!(true);
        deck["solver_settings"]["contact_settings"]["max_number_splits"] = json!(0);
        let supports = deck["processes"]["constraints_process_list"].as_array_mut().expect("a list");
        let mut top = supports[0].clone();
        top["Parameters"]["model_part_name"] = json!("Structure.Top");
        top["Parameters"]["value"] = json!([null, "-2.5*t", null]);
        supports.push(top);
    });
    let path = scratch.path().join("mesh.mdpa");
    let mesh = std::fs::read_to_string(&path).expect("the mesh");
    std::fs::write(path, mesh.replace("SmallDisplacementElement2D4N", "TotalLagrangianElement2D4N")).expect("the mesh");
    let (code, said) = run(scratch.path(), "run");
    assert_ne!(code, Some(0), "{said}");
    assert!(said.contains("elements are inside out, the first is TotalLagrangianElement2D4N"), "{said}");
}
