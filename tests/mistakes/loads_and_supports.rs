//! Loads that no condition takes, slaves that face no master, contact that no step meets or that one solve cannot find, and supports that something else would take the place of.

use serde_json::json;

use crate::DECK;
use crate::support::{read_json, root, said, scratch_copy, zelus};
use crate::table::{PRESSED, contact, load, support};

#[test]
fn a_constraint_on_a_supported_node_is_refused() {
    let scratch = scratch_copy(&root().join("tests/cases/structural/bar_thickness"));
    let path = scratch.path().join("mesh.mdpa");
    let mesh = std::fs::read_to_string(&path).expect("the mesh");
    let with = |slave: usize, master: usize, constant: f64| {
        let constraint = format!(
            "Begin Constraints LinearMasterSlaveConstraint DISPLACEMENT_X DISPLACEMENT_X\n1 {constant} [1.0] {slave} {master}\n\
             End Constraints\n\n"
        );
        let (head, parts) = mesh.split_once("Begin SubModelPart").expect("parts");
        std::fs::write(&path, format!("{head}{constraint}Begin SubModelPart{parts}")).expect("a file");
        let both = ["check", "run"].map(|command| zelus(scratch.path(), &[command, DECK]));
        let [checked, run] = both.each_ref().map(|output| output.status.code());
        assert_eq!(checked, run, "the check and the run agree: {}", said(&both[0]));
        (run, said(&both[1]))
    };
    for (master, constant, why) in
        [(7, 0.0, "a support prescribes it"), (6, 1e-3, "gives it 0.001, and a support prescribes 0")]
    {
        let (code, said) = with(1, master, constant);
        let words = ["error[constraint-on-support]", "DISPLACEMENT_X of node 1", why];
        assert!(code == Some(2) && words.iter().all(|word| said.contains(word)), "{code:?} {said}");
    }
    // A free node may follow a supported one, and supported nodes each other.
    for (slave, master, constant) in [(7, 1, 1e-3), (1, 6, 0.0)] {
        let (code, said) = with(slave, master, constant);
        assert_eq!(code, Some(0), "{slave} follows {master}: {said}");
    }
}

#[test]
fn a_load_on_nodes_that_no_condition_takes_is_named() {
    let scratch = scratch_copy(&root().join("tests/cases").join(PRESSED));
    let path = scratch.path().join(DECK);
    let mut deck = read_json(&path).expect("the deck");
    let part = load(&mut deck)["model_part_name"].clone();
    let mut of_nodes = |variable: &str| {
        deck["processes"]["loads_process_list"][0] = json!({
            "python_module": "assign_vector_variable_process",
            "kratos_module": "KratosMultiphysics",
            "Parameters": {
                "model_part_name": part, "variable_name": variable, "constrained": [false, false, false],
                "value": [0.0, "-1.0e3*t", 0.0]
            }
        });
        std::fs::write(&path, serde_json::to_string_pretty(&deck).expect("JSON")).expect("a file");
        said(&zelus(scratch.path(), &["check", DECK]))
    };
    let said = of_nodes("POINT_LOAD");
    assert!(said.contains("warning[acts-on-nothing]") && said.contains("takes POINT_LOAD"), "{said}");
    let said = of_nodes("LINE_LOAD");
    assert!(!said.contains("acts-on-nothing"), "line loads read it at their nodes: {said}");
}

#[test]
fn a_load_that_nothing_resists_is_refused() {
    let scratch = scratch_copy(&root().join("tests/cases/structural/bar_thickness"));
    let path = scratch.path().join("mesh.mdpa");
    let mesh = std::fs::read_to_string(&path).expect("the mesh");
    let check = |node: usize, condition: &str| {
        let (head, parts) = mesh.split_once("Begin SubModelPart").expect("parts");
        let head = head.replacen("End Nodes", "99 50.0 60.0 0.0\nEnd Nodes", 1);
        let load = format!("Begin Conditions {condition}2D1N\n900 0 {node}\nEnd Conditions\n\n");
        std::fs::write(&path, format!("{head}{load}Begin SubModelPart{parts}")).expect("a file");
        let output = zelus(scratch.path(), &["check", DECK]);
        (output.status.code(), said(&output))
    };
    for (node, condition, unknown) in
        [(7, "PointMomentCondition", "ROTATION_Z of node 7"), (99, "PointLoadCondition", "DISPLACEMENT_X of node 99")]
    {
        let (code, said) = check(node, condition);
        let words = ["error[unresisted-load]", unknown, "reference node of a coupling"];
        assert!(code == Some(2) && words.iter().all(|word| said.contains(word)), "{code:?} {said}");
    }
    let (code, said) = check(7, "PointLoadCondition");
    assert!(code == Some(0) && !said.contains("unresisted"), "{code:?} {said}");
}

#[test]
fn a_support_that_constrains_nothing_is_named() {
    let scratch = scratch_copy(&root().join("tests/cases").join(PRESSED));
    let path = scratch.path().join(DECK);
    let mut deck = read_json(&path).expect("the deck");
    let mut check = |constrained: [bool; 3]| {
        support(&mut deck)["constrained"] = json!(constrained);
        std::fs::write(&path, serde_json::to_string_pretty(&deck).expect("JSON")).expect("a file");
        said(&zelus(scratch.path(), &["check", DECK]))
    };
    let free = check([false; 3]);
    assert!(free.contains("warning[acts-on-nothing]") && free.contains("a value that is not constrained"), "{free}");
    let held = check([true, false, false]);
    assert!(!held.contains("acts-on-nothing"), "{held}");
}

#[test]
fn a_model_that_nothing_loads_is_named() {
    let scratch = scratch_copy(&root().join("tests/cases").join(PRESSED));
    let path = scratch.path().join(DECK);
    let mut deck = read_json(&path).expect("the deck");
    let mut check = |loads: serde_json::Value| {
        deck["processes"]["loads_process_list"] = loads;
        std::fs::write(&path, serde_json::to_string_pretty(&deck).expect("JSON")).expect("a file");
        said(&zelus(scratch.path(), &["check", DECK]))
    };
    let nothing = check(json!([]));
    assert!(nothing.contains("warning[no-load]") && nothing.contains("nothing loads or moves the model"), "{nothing}");
    let moved = check(json!([{"python_module": "assign_scalar_variable_process", "Parameters": {
        "model_part_name": "Structure.Bottom", "variable_name": "DISPLACEMENT_Y", "value": "1.0e-6*t"}}]));
    assert!(!moved.contains("no-load"), "a prescribed motion moves it: {moved}");
}

#[test]
fn gravity_and_inertia_without_density_are_named() {
    let scratch = scratch_copy(&root().join("tests/cases/structural/self_weight"));
    let whole = said(&zelus(scratch.path(), &["check", DECK]));
    assert!(!whole.contains("acts-on-nothing"), "{whole}");
    let path = scratch.path().join("StructuralMaterials.json");
    let mut materials = read_json(&path).expect("materials");
    for own in materials["properties"].as_array_mut().expect("a list") {
        own["Material"]["Variables"].as_object_mut().expect("variables").remove("DENSITY");
    }
    std::fs::write(&path, materials.to_string()).expect("a file");
    let without = said(&zelus(scratch.path(), &["check", DECK]));
    let fact = "VOLUME_ACCELERATION by assign_vector_by_direction_process on Structure.Body acts on nothing: property 1 has no DENSITY";
    assert!(without.contains("warning[acts-on-nothing]") && without.contains(fact), "{without}");
    let dynamic = ["solver_settings.solver_type=Dynamic", "solver_settings.scheme_type=newmark"];
    let dynamic = said(&zelus(scratch.path(), &["check", DECK, "--set", dynamic[0], "--set", dynamic[1]]));
    assert!(dynamic.contains("warning[no-mass]"), "{dynamic}");
}

#[test]
fn contact_that_no_step_meets_is_named() {
    let scratch = scratch_copy(&root().join("tests/cases").join(PRESSED));
    let path = scratch.path().join(DECK);
    let mut deck = read_json(&path).expect("the deck");
    contact(&mut deck)["interval"] = json!([0.0, 0.0]);
    std::fs::write(&path, serde_json::to_string_pretty(&deck).expect("JSON")).expect("a file");
    let said = said(&zelus(scratch.path(), &["check", DECK]));
    assert!(said.contains("warning[interval-outside]") && said.contains("no step of the run"), "{said}");
}

#[test]
fn a_direction_that_leaves_the_plane_is_named() {
    let scratch = scratch_copy(&root().join("tests/cases").join(PRESSED));
    let path = scratch.path().join(DECK);
    let mut deck = read_json(&path).expect("the deck");
    load(&mut deck)["direction"] = json!([0.0, -0.8, 0.6]);
    std::fs::write(&path, serde_json::to_string_pretty(&deck).expect("JSON")).expect("a file");
    let said = said(&zelus(scratch.path(), &["check", DECK]));
    assert!(said.contains("warning[acts-on-nothing]") && said.contains("out of the plane, which is lost"), "{said}");
}

#[test]
fn contact_in_a_linear_analysis_is_refused() {
    let scratch = scratch_copy(&root().join("tests/cases").join(PRESSED));
    let path = scratch.path().join(DECK);
    let mut deck = read_json(&path).expect("the deck");
    deck["solver_settings"]["analysis_type"] = json!("linear");
    std::fs::write(&path, serde_json::to_string_pretty(&deck).expect("JSON")).expect("a file");
    let output = zelus(scratch.path(), &["run", DECK]);
    let said = said(&output);
    assert!(output.status.code() == Some(2) && said.contains("error[linear-contact]"), "{said}");
}

#[test]
fn slaves_of_a_tie_that_face_no_master_are_named() {
    let scratch = scratch_copy(&root().join("tests/cases/mesh_tying/quadrilaterals"));
    let whole = said(&zelus(scratch.path(), &["run", DECK]));
    assert!(!whole.contains("slaves-not-tied"), "all face a master: {whole}");
    // The upper body, nodes 13 to 27, is moved along the interface by half of its width.
    let path = scratch.path().join("mesh.mdpa");
    let mesh = std::fs::read_to_string(&path).expect("the mesh");
    let moved = |line: &str| {
        let words: Vec<&str> = line.split(' ').collect();
        let [id, x, y, "0"] = words[..] else { return line.to_owned() };
        match (id.parse::<usize>(), x.parse::<f64>(), y.parse::<f64>()) {
            (Ok(id), Ok(x), Ok(y)) if (13..=27).contains(&id) => format!("{id} {} {} 0", x + 0.5, y + 0.125),
            _ => line.to_owned(),
        }
    };
    let (nodes, rest) = mesh.split_once("End Nodes").expect("nodes");
    let nodes: Vec<String> = nodes.lines().map(moved).collect();
    std::fs::write(&path, format!("{}\nEnd Nodes{rest}", nodes.join("\n"))).expect("a file");
    let said = said(&zelus(scratch.path(), &["run", DECK]));
    assert!(
        said.contains("warning[slaves-not-tied]") && said.contains("slave nodes of the tie face no master"),
        "{said}"
    );
}
