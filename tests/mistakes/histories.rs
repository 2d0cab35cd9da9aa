//! Results that must be told as they are: histories, nodal results of contact by constraints, stresses at an interface of materials.

use serde_json::{Value, json};
use zelus::core::io::results::read_vtu;

use crate::support::{read_json, root, said, scratch_copy, zelus};
use crate::table::PRESSED;
use crate::{DECK, MATERIALS};

/// A history of these variables at the nodes of a part, of columns with history or without.
fn history(part: &str, file: &str, variables: &[&str], historical: bool) -> Value {
    json!({"python_module": "json_output_process", "kratos_module": "KratosMultiphysics", "Parameters": {
        "model_part_name": part, "output_file_name": file, "output_variables": variables,
        "historical_value": historical, "time_frequency": 0.0}})
}

/// The run of a case with these processes of output, and what it has said.
fn run(case: &str, outputs: &[Value], more: &dyn Fn(&mut Value)) -> (tempfile::TempDir, String) {
    let scratch = scratch_copy(&root().join("tests/cases").join(case));
    let path = scratch.path().join(DECK);
    let mut deck = read_json(&path).expect("the deck");
    deck["processes"]["json_output_process_list"] = json!(outputs);
    more(&mut deck);
    std::fs::write(&path, deck.to_string()).expect("the deck");
    let output = zelus(scratch.path(), &["run", DECK]);
    let said = said(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    (scratch, said)
}

/// The numbers of one variable at the last time, by node.
fn last(file: &Value, variable: &str) -> Vec<f64> {
    let nodes = file.as_object().expect("nodes").iter().filter(|(key, _)| key.starts_with("NODE"));
    nodes.filter_map(|(_, node)| node[variable].as_array()?.last()?.as_f64()).collect()
}

#[test]
fn histories_give_values_wherever_they_are_kept() {
    const NAMES: [&str; 6] = [
        "CONTACT_PRESSURE",
        "NODAL_H",
        "INITIAL_PENALTY",
        "REACTION",
        "NORMAL",
        "LAGRANGE_MULTIPLIER_CONTACT_PRESSURE",
    ];
    let outputs = [true, false].map(|historical| {
        history("Structure.Slave", if historical { "with.json" } else { "without.json" }, &NAMES, historical)
    });
    let (folder, said) = run(PRESSED, &outputs, &|_| {});
    assert!(!said.contains("no-values"), "{said}");
    for file in ["with.json", "without.json"] {
        let file = read_json(&folder.path().join(file)).expect("a history");
        for name in NAMES.map(|name| match name {
            "REACTION" | "NORMAL" => format!("{name}_Y"),
            _ => name.to_owned(),
        }) {
            let values = last(&file, &name);
            let needed = name != "REACTION_Y";
            assert!(!values.is_empty() && (!needed || values.iter().all(|value| *value != 0.0)), "{name}: {values:?}");
        }
    }
}

#[test]
fn contact_by_constraints_tells_its_forces() {
    const NAMES: [&str; 4] = ["CONTACT_STATUS", "CONTACT_PRESSURE", "CONTACT_TRACTION", "CONTACT_FORCE"];
    let outputs = [
        history("Structure.Slave", "slave.json", &NAMES, false),
        history("Structure", "whole.json", &["CONTACT_FORCE", "REACTION"], false),
        history("Structure.Top", "top.json", &["REACTION"], true),
    ];
    // The bodies are pressed together in the second of three steps.
    let (folder, _) = run("mpc/pressed_and_opened", &outputs, &|deck| deck["problem_data"]["end_time"] = json!(1.0));
    let read = |name: &str| read_json(&folder.path().join(name)).expect("a history");
    let (slave, whole, top) = (read("slave.json"), read("whole.json"), read("top.json"));
    let status = last(&slave, "CONTACT_STATUS");
    assert!(status.iter().all(|status| *status == 2.0), "{status:?}");
    let pressures = last(&slave, "CONTACT_PRESSURE");
    let width = pressures.iter().copied().fold(f64::INFINITY, f64::min) / pressures.iter().copied().fold(0.0, f64::max);
    assert!(width > 0.999, "a constant pressure: {pressures:?}");
    let force: f64 = last(&slave, "CONTACT_FORCE_Y").iter().sum();
    let load: f64 = last(&top, "REACTION_Y").iter().sum();
    assert!(force > 0.0 && (force + load).abs() < 1e-6 * force, "contact bears what the top presses: {force} {load}");
    let total: f64 = last(&whole, "CONTACT_FORCE_Y").iter().sum();
    assert!(total.abs() < 1e-9 * force, "both sides balance: {total}");
}

#[test]
fn cells_show_stresses_where_materials_meet() {
    let scratch = scratch_copy(&root().join("tests/cases/structural/bar_thickness"));
    let path = scratch.path().join(DECK);
    let mut deck = read_json(&path).expect("the deck");
    deck["output_processes"] = json!({"vtu": [{"python_module": "vtu_output_process", "Parameters":
        {"model_part_name": "Structure", "output_path": "vtu"}}]});
    std::fs::write(&path, deck.to_string()).expect("the deck");
    let cells = |scratch: &tempfile::TempDir| {
        let output = zelus(scratch.path(), &["run", DECK]);
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        let picture = read_vtu(&scratch.path().join("vtu/Structure_1.vtu")).expect("a picture");
        picture.cell_data.iter().map(|column| column.name.clone()).collect::<Vec<String>>()
    };
    assert!(!cells(&scratch).contains(&"VON_MISES_STRESS".to_owned()), "one material");
    let mesh = scratch.path().join("mesh.mdpa");
    let text = std::fs::read_to_string(&mesh).expect("the mesh");
    let nodes: String = text.split("Begin SubModelPart Body").nth(1).expect("the body").to_owned();
    let list =
        nodes.split("Begin SubModelPartNodes").nth(1).and_then(|rest| rest.split("End SubModelPartNodes").next());
    let half = format!(
        "\nBegin SubModelPart Half\nBegin SubModelPartNodes\n{}\nEnd SubModelPartNodes\nBegin SubModelPartElements\n1\n2\n\
         End SubModelPartElements\nEnd SubModelPart\n",
        list.expect("nodes").trim()
    );
    let nested = text.replacen("Begin SubModelPart Body\n", &format!("Begin SubModelPart Body\n{half}"), 1);
    std::fs::write(&mesh, nested).expect("the mesh");
    let path = scratch.path().join(MATERIALS);
    let mut materials = read_json(&path).expect("materials");
    let mut soft = materials["properties"][0].clone();
    soft["model_part_name"] = json!("Structure.Body.Half");
    soft["properties_id"] = json!(2);
    soft["Material"]["Variables"]["YOUNG_MODULUS"] = json!(2e8);
    materials["properties"].as_array_mut().expect("a list").push(soft);
    std::fs::write(&path, materials.to_string()).expect("materials");
    assert!(cells(&scratch).contains(&"VON_MISES_STRESS".to_owned()), "two materials");
}
