//! Friction by the penalty method beyond single cases: history over steps, balance of momentum in explicit steps.

use crate::support::{Results, read_json, root, said, scratch_copy, zelus};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::Path;

const DECK: &str = "ProjectParameters.json";

fn write_json(path: &Path, value: &Value) {
    std::fs::write(path, serde_json::to_string_pretty(value).expect("JSON")).expect("a file");
}

fn run(folder: &Path) {
    let output = zelus(folder, &["run", DECK, "--threads", "2"]);
    assert!(output.status.success(), "{}", said(&output));
}

/// The sheared block that sticks, its loads F following `course`, in `steps`.
fn sheared(course: &str, steps: usize, end: f64) -> Results {
    let scratch = scratch_copy(&root().join("tests/cases/contact_2d/friction_penalty_stick"));
    let mut deck = read_json(&scratch.path().join(DECK)).expect("the deck");
    for load in deck["processes"]["loads_process_list"].as_array_mut().expect("loads") {
        let modulus = load["Parameters"]["modulus"].as_f64().expect("a number");
        load["Parameters"]["modulus"] = json!(course.replace('F', &format!("{modulus}")));
    }
    deck["problem_data"]["end_time"] = json!(end);
    deck["solver_settings"]["time_stepping"]["time_step"] = json!(end / steps as f64);
    write_json(&scratch.path().join(DECK), &deck);
    run(scratch.path());
    Results::read(&scratch.path().join("slave.json")).expect("results")
}

fn tractions(results: &Results) -> Vec<f64> {
    let step = results.step(None).expect("a step");
    results.nodal("FRICTION_TRACTION_X", step).into_values().collect()
}

/// Below the bound friction is elastic: the way to a load does not matter, and neither does staying there.
#[test]
fn sticking_carries_the_traction_from_step_to_step() {
    let at_once = tractions(&sheared("F*t", 1, 1.0));
    for (course, steps, end) in
        [("F*t", 7, 1.0), ("2.0*F*t if t < 0.5 else F", 8, 1.0), ("F*t if t < 1.2 else F*(2.4 - t)", 7, 1.4)]
    {
        for (found, expected) in tractions(&sheared(course, steps, end)).iter().zip(&at_once) {
            assert!((found - expected).abs() < 2e-4 * expected.abs(), "{course}: {found}, at once {expected}");
        }
    }
}

/// A block of 0.2 × 0.2 with ρ = 1, pressed down by 10 and thrown along a rigid plane.
fn thrown(speed: f64, friction: f64, time_step: f64, end: f64) -> (Results, Value) {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let mut mesh =
        String::from("Begin ModelPartData\nEnd ModelPartData\n\nBegin Properties 0\nEnd Properties\n\nBegin Nodes\n");
    let mut node = 0;
    for (xs, ys) in [(vec![-0.2, 0.35, 0.9], vec![-0.1, 0.0]), (vec![0.0, 0.1, 0.2], vec![0.0, 0.1, 0.2])] {
        for y in &ys {
            for x in &xs {
                node += 1;
                writeln!(mesh, "{node} {:e} {:e} 0", x + 3.0, y + 2.0).unwrap();
            }
        }
    }
    mesh.push_str("End Nodes\n\nBegin Elements SmallDisplacementElement2D4N\n");
    let cells = [[1, 2, 5, 4], [2, 3, 6, 5], [7, 8, 11, 10], [8, 9, 12, 11], [10, 11, 14, 13], [11, 12, 15, 14]];
    for (at, [a, b, c, d]) in cells.iter().enumerate() {
        writeln!(mesh, "{} 0 {a} {b} {c} {d}", at + 1).unwrap();
    }
    mesh.push_str(
        "End Elements\n\nBegin Conditions LineCondition2D2N\n1 0 5 4\n2 0 6 5\n3 0 7 8\n4 0 8 9\nEnd Conditions\n",
    );
    mesh.push_str("\nBegin Conditions LineLoadCondition2D2N\n5 0 14 13\n6 0 15 14\nEnd Conditions\n");
    let mut part = |name: &str, nodes: &[usize], elements: &[usize], conditions: &[usize]| {
        writeln!(mesh, "\nBegin SubModelPart {name}").unwrap();
        for (kind, list) in [("Nodes", nodes), ("Elements", elements), ("Conditions", conditions)] {
            let lines: String = list.iter().map(|id| format!("    {id}\n")).collect();
            write!(mesh, "  Begin SubModelPart{kind}\n{lines}  End SubModelPart{kind}\n").unwrap();
        }
        mesh.push_str("End SubModelPart\n");
    };
    let block: Vec<usize> = (7..=15).collect();
    part("Plane", &[1, 2, 3, 4, 5, 6], &[1, 2], &[1, 2]);
    part("Block", &block, &[3, 4, 5, 6], &[3, 4, 5, 6]);
    part("Interface", &[4, 5, 6, 7, 8, 9], &[], &[1, 2, 3, 4]);
    part("Slave", &[7, 8, 9], &[], &[3, 4]);
    part("Top", &[13, 14, 15], &[], &[5, 6]);
    std::fs::write(folder.path().join("mesh.mdpa"), mesh).expect("the mesh");
    let material = |name: &str, id: usize| {
        json!({"model_part_name": format!("Structure.{name}"), "properties_id": id, "Material": {
            "constitutive_law": {"name": "LinearElasticPlaneStress2DLaw"},
            "Variables": {"YOUNG_MODULUS": 1e4, "POISSON_RATIO": 0.0, "DENSITY": 1.0}, "Tables": {}}})
    };
    write_json(
        &folder.path().join("StructuralMaterials.json"),
        &json!({"properties": [material("Plane", 1), material("Block", 2)]}),
    );
    let assign = |part: &str, variable: &str, value: Value, constrained: bool, interval: Value| {
        json!({"python_module": "assign_vector_variable_process", "kratos_module": "KratosMultiphysics", "Parameters": {
            "model_part_name": format!("Structure.{part}"), "variable_name": variable,
            "constrained": [constrained, constrained, true], "value": value, "interval": interval}})
    };
    write_json(
        &folder.path().join(DECK),
        &json!({
            "problem_data": {"problem_name": "thrown", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0,
                "end_time": end},
            "solver_settings": {
                "solver_type": "Dynamic", "model_part_name": "Structure", "domain_size": 2, "echo_level": 0,
                "time_integration_method": "explicit", "scheme_type": "central_differences",
                "model_import_settings": {"input_type": "mdpa", "input_filename": "mesh"},
                "material_import_settings": {"materials_filename": "StructuralMaterials.json"},
                "time_step_prediction_level": 0, "time_stepping": {"time_step": time_step},
                "contact_settings": {"mortar_type": "PenaltyContactFrictional"}},
            "processes": {
                "constraints_process_list": [assign("Plane", "DISPLACEMENT", json!([0.0, 0.0, 0.0]), true, json!([0.0, "End"]))],
                "initial_conditions_process_list": [assign("Block", "VELOCITY", json!([speed, 0.0, 0.0]), false, json!([0.0, 0.0]))],
                "loads_process_list": [{"python_module": "assign_vector_by_direction_to_condition_process",
                    "kratos_module": "KratosMultiphysics", "Parameters": {"model_part_name": "Structure.Top",
                        "variable_name": "LINE_LOAD", "modulus": 10.0, "direction": [0.0, -1.0, 0.0], "interval": [0.0, "End"]}}],
                "contact_process_list": [{"python_module": "explicit_penalty_contact_process",
                    "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication", "Parameters": {
                        "model_part_name": "Structure", "contact_type": "Frictional",
                        "contact_model_part": {"0": ["Interface"]}, "assume_master_slave": {"0": ["Slave"]},
                        "friction_coefficients": {"0": friction}}}],
                "json_output_process_list": [{"python_module": "json_output_process", "kratos_module": "KratosMultiphysics",
                    "Parameters": {"output_file_name": "block.json", "model_part_name": "Structure.Block",
                        "output_variables": ["DISPLACEMENT", "VELOCITY"], "time_frequency": 0.0}}]}}),
    );
    let output = zelus(folder.path(), &["run", DECK, "--threads", "2", "--report", "run.json"]);
    assert!(output.status.success(), "{}", said(&output));
    let report = read_json(&folder.path().join("run.json")).expect("a report");
    (Results::read(&folder.path().join("block.json")).expect("results"), report)
}

/// Mean of a quantity over the mass of the block of three by three nodes.
fn mean(results: &Results, quantity: &str, step: usize) -> f64 {
    let weight = |node: u64| match node - 7 {
        4 => 4.0,
        1 | 3 | 5 | 7 => 2.0,
        _ => 1.0,
    };
    results.nodal(quantity, step).iter().map(|(&node, v)| weight(node) * v).sum::<f64>() / 16.0
}

/// Friction is μ times the pressing force in every step, however the block shakes: with the momenta of both directions,
/// m Δv_x = −μ (m Δv_y + P t), P the load. Velocities are those of the step's start.
#[test]
fn an_explicit_block_slides_against_friction_times_the_pressing_force() {
    let (friction, speed, time_step, mass, load) = (0.3, 1.0, 1e-4, 0.04, 2.0);
    let (results, report) = thrown(speed, friction, time_step, 0.03);
    let end = results.len() - 1;
    for step in [end / 3, 2 * end / 3, end] {
        let time = results.times()[step] - time_step;
        let lost = mass * (speed - mean(&results, "VELOCITY_X", step));
        let pressed = mass * mean(&results, "VELOCITY_Y", step) + load * time;
        println!("t = {time:.4}: {lost:.6} of momentum lost, {:.6} by friction", friction * pressed);
        assert!(lost > 0.1 * friction * load * time, "hardly braked: {lost}");
        assert!((lost / (friction * pressed) - 1.0).abs() < 2e-3, "{lost}, expected {}", friction * pressed);
    }
    // Heat of friction, the sum of μ N Δs with N from the momenta; energies are those at the start of a step. ANALYTIC; tolerance:
    // the block rocks, so that the node that presses most slides less than the mean of the three.
    let heat = |step: usize| report["steps"][step]["balance"]["energies"]["dissipated"].as_f64().expect("heat");
    let pressed = |step: usize| {
        let faster = mean(&results, "VELOCITY_Y", step + 1) - mean(&results, "VELOCITY_Y", step);
        mass * faster / time_step + load
    };
    let place = |step: usize| {
        let moved = results.nodal("DISPLACEMENT_X", step);
        (moved[&7] + moved[&8] + moved[&9]) / 3.0
    };
    let slid = |step: usize| place(step) - place(step - 1);
    let expected: f64 = (1..end).map(|step| friction * pressed(step) * slid(step)).sum();
    println!("{:.6e} of heat, expected {expected:.6e}", heat(end));
    assert!((heat(end) / expected - 1.0).abs() < 0.03, "heat {}, not {expected}", heat(end));
    let remainder = report["steps"][end]["balance"]["energies"]["remainder"].as_f64().expect("a remainder");
    assert!(remainder.abs() < 0.01 * 0.5 * mass * speed * speed, "off by {remainder}");
}

/// A block that is slow comes to rest where the work of friction has used up its energy, and stays there.
#[test]
fn an_explicit_block_comes_to_rest() {
    let (friction, speed, mass, load) = (0.3, 0.3, 0.04, 2.0);
    let (results, _) = thrown(speed, friction, 1e-4, 0.06);
    let end = results.len() - 1;
    let way = 0.5 * mass * speed * speed / (friction * load);
    let moved = |step: usize| mean(&results, "DISPLACEMENT_X", step);
    println!("came to rest after {:.3e}, later {:.3e}, expected {way:.3e}", moved(2 * end / 3), moved(end));
    // The pressing force swings about the load.
    assert!((moved(end) / way - 1.0).abs() < 0.1, "{} of {way}", moved(end));
    assert!((moved(end) - moved(2 * end / 3)).abs() < 0.03 * way, "it creeps");
}
