//! Every builder gives the same answer with constraints, reactions included.

use crate::support::{Results, change, read_json, root, said, scratch_copy, zelus};
use serde_json::{Value, json};

/// A block under a plate whose nodes follow node 17, the loaded one, by constraints of the mesh file.
fn plate(builder: &str, with_constraints: bool, constraints: &[(u32, f64, f64)]) -> Results {
    let scratch = scratch_copy(&root().join("tests/cases/constraints/rigid_plate"));
    let rows: String = constraints
        .iter()
        .enumerate()
        .map(|(at, (slave, constant, weight))| format!("{} {constant:e} [{weight}] {slave} 17\n", at + 1))
        .collect();
    let header = "Begin Constraints LinearMasterSlaveConstraint DISPLACEMENT_Y DISPLACEMENT_Y";
    let first = "Begin SubModelPart Body";
    change(scratch.path(), "mesh.mdpa", first, &format!("{header}\n{rows}End Constraints\n\n{first}"));
    let path = scratch.path().join("ProjectParameters.json");
    let mut deck = read_json(&path).expect("the deck");
    let settings = deck["solver_settings"].as_object_mut().expect("settings");
    settings.insert("builder_and_solver_settings".into(), json!({ "type": builder }));
    settings.insert("multi_point_constraints_used".into(), json!(with_constraints));
    settings["residual_relative_tolerance"] = json!(1e-13);
    let processes = &mut deck["processes"];
    let list = processes["constraints_process_list"].as_array_mut().expect("a list");
    list.retain(|process| process["python_module"] != "impose_rigid_movement_process");
    processes["json_output_process_list"][0]["Parameters"]["output_variables"] = json!(["DISPLACEMENT", "REACTION"]);
    std::fs::write(&path, Value::to_string(&deck)).expect("the deck");
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json"]);
    assert!(output.status.success(), "{}", said(&output));
    Results::read(&scratch.path().join("results.json")).expect("results")
}

fn builders(constraints: &[(u32, f64, f64)]) -> [Results; 3] {
    [("block", true), ("elimination", false), ("elimination", true)].map(|(b, c)| plate(b, c, constraints))
}

/// Largest relative difference between the builders, over all quantities.
fn assert_same(results: &[Results; 3]) {
    for quantity in ["DISPLACEMENT_X", "DISPLACEMENT_Y", "REACTION_X", "REACTION_Y"] {
        let [block, others @ ..] = results.each_ref().map(|r| r.nodal(quantity, 0));
        let scale = block.values().fold(0.0_f64, |most, v| most.max(v.abs()));
        for other in others {
            for (node, value) in &block {
                let difference = (other[node] - value).abs();
                assert!(difference <= 1e-12 * scale, "{quantity} of node {node}: {value} and {}", other[node]);
            }
        }
    }
}

/// ANALYTIC: uniform compression under 1e6 on a width of 1, so that the five bottom nodes carry 1/8, 1/4, 1/4, 1/4, 1/8,
/// and each node of the plate hands on its share of the load.
#[test]
fn tied_nodes_give_the_same_answer_and_the_right_reactions_in_every_builder() {
    let results = builders(&[16, 18, 19, 20].map(|slave| (slave, 0.0, 1.0)));
    assert_same(&results);
    let reactions = results[0].nodal("REACTION_Y", 0);
    for (nodes, total) in [([1, 2, 3, 4, 5], 1.0e6), ([16, 17, 18, 19, 20], 0.0)] {
        for (at, node) in nodes.into_iter().enumerate() {
            let share = if at % 4 == 0 { 0.125e6 } else { 0.25e6 };
            let exact = match (total, node) {
                (0.0, 17) => 1.0e6 - share,
                (0.0, _) => -share,
                _ => share,
            };
            let found = reactions[&node];
            assert!((found - exact).abs() < 1e-3, "node {node} carries {found}, not {exact}");
        }
    }
}

/// Weights and constants: u_s = w u_17 + g holds, the forces of the ties do no work, and the whole is in balance.
#[test]
fn weighted_constraints_give_the_same_answer_in_every_builder() {
    let constraints = [(16, 1e-5, 0.5), (18, -2e-5, 1.25), (19, 0.0, 1.0), (20, 3e-5, 0.75)];
    let results = builders(&constraints);
    assert_same(&results);
    let u = results[0].nodal("DISPLACEMENT_Y", 0);
    let reactions = results[0].nodal("REACTION_Y", 0);
    let mut work = reactions[&17];
    for (slave, constant, weight) in constraints {
        let slave = u64::from(slave);
        assert!((u[&slave] - weight * u[&17] - constant).abs() < 1e-15, "node {slave} does not obey");
        work += weight * reactions[&slave];
    }
    assert!(work.abs() < 1e-3, "the ties do the work {work} on their master's motion");
    let total: f64 = reactions.values().sum();
    assert!((total - 1.0e6).abs() < 1e-3, "supports and ties together carry {total}");
}
