//! A body that is stretched while something diffuses in it: two unknowns at each node, whose units have nothing in common.

use std::process::Command;

use serde_json::{Value, json};

const CELLS: usize = 6;

/// Quadrilaterals of both kinds on the same nodes of a strip of length 1.
fn mesh() -> String {
    let h = 1.0 / CELLS as f64;
    let mut text = "Begin Properties 1\n  DIFFUSIVITY 2.0\n  STORAGE 3.0\nEnd Properties\nBegin Properties 2\n\
                    End Properties\nBegin Nodes\n"
        .to_owned();
    for column in 0..=CELLS {
        for row in 0..2 {
            text += &format!("{} {} {} 0.0\n", 2 * column + row + 1, column as f64 * h, row as f64 * h);
        }
    }
    text += "End Nodes\n";
    for (kind, properties, first) in [("DiffusionElement2D4N", 1, 1), ("TotalLagrangianElement2D4N", 2, CELLS + 1)] {
        text += &format!("Begin Elements {kind}\n");
        for cell in 0..CELLS {
            let low = 2 * cell + 1;
            text += &format!("{} {properties} {low} {} {} {}\n", first + cell, low + 2, low + 3, low + 1);
        }
        text += "End Elements\n";
    }
    let solids: String = (CELLS + 1..=2 * CELLS).map(|id| format!("    {id}\n")).collect();
    let all: String = (1..=2 * (CELLS + 1)).map(|id| format!("    {id}\n")).collect();
    for (name, nodes, elements) in [
        ("Solid", all, solids),
        ("Left", "    1\n    2\n".to_owned(), String::new()),
        ("Right", format!("    {}\n    {}\n", 2 * CELLS + 1, 2 * CELLS + 2), String::new()),
    ] {
        text += &format!(
            "Begin SubModelPart {name}\n  Begin SubModelPartNodes\n{nodes}  End SubModelPartNodes\n  \
             Begin SubModelPartElements\n{elements}  End SubModelPartElements\nEnd SubModelPart\n"
        );
    }
    text
}

fn concentration(part: &str, value: f64) -> Value {
    json!({"python_module": "assign_scalar_variable_process",
        "Parameters": {"model_part_name": format!("Body.{part}"), "variable_name": "CONCENTRATION", "value": value}})
}

fn motion(part: &str, x: f64) -> Value {
    json!({"python_module": "assign_vector_variable_process", "Parameters": {
        "model_part_name": format!("Body.{part}"), "variable_name": "DISPLACEMENT", "value": [x, 0.0, 0.0]}})
}

/// Iterations of the step where concentrations are counted in a unit in which that at the left end is `unit`.
fn iterations(unit: f64, criterion: &str, sums: bool) -> usize {
    let folder = tempfile::tempdir().unwrap();
    let deck = json!({
        "problem_data": {"problem_name": "strip", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0,
            "end_time": 1.0},
        "solver_settings": {"solver_type": "Static", "model_part_name": "Body", "domain_size": 2,
            "model_import_settings": {"input_type": "mdpa", "input_filename": "strip"},
            "material_import_settings": {"materials_filename": "materials.json"},
            "convergence_criterion": criterion, "criterion_sums_variables": sums, "check_body_balance": !sums, "time_stepping": {"time_step": 1.0}},
        "processes": {"list": [concentration("Left", unit), concentration("Right", 0.0), motion("Left", 0.0),
            motion("Right", 0.5)]}
    });
    let materials = json!({"properties": [{"model_part_name": "Body.Solid", "properties_id": 2, "Material": {
        "constitutive_law": {"name": "LinearElasticPlaneStrain2DLaw"},
        "Variables": {"YOUNG_MODULUS": 1000.0, "POISSON_RATIO": 0.3}, "Tables": {}}}]});
    std::fs::write(folder.path().join("strip.mdpa"), mesh()).unwrap();
    std::fs::write(folder.path().join("deck.json"), deck.to_string()).unwrap();
    std::fs::write(folder.path().join("materials.json"), materials.to_string()).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_zelus-plugin"));
    let output = command.args(["run", "deck.json", "--report", "report.json"]).current_dir(folder.path()).output();
    let output = output.expect("a run");
    let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{said}");
    let report = std::fs::read_to_string(folder.path().join("report.json")).unwrap();
    let report: Value = serde_json::from_str(&report).unwrap();
    report["steps"][0]["iterations"].as_array().unwrap().len()
}

#[test]
fn the_unit_of_one_unknown_changes_no_count_of_iterations() {
    for criterion in ["residual_criterion", "displacement_criterion", "and_criterion"] {
        let counts = [1e-9, 1e-3, 1.0, 1e3, 1e9].map(|unit| iterations(unit, criterion, false));
        assert!(counts[0] > 2 && counts.iter().all(|count| *count == counts[0]), "{criterion}: {counts:?}");
    }
}

/// Kratos' sum over both unknowns, which the default avoids: the larger numbers decide alone.
#[test]
fn a_sum_over_both_depends_on_the_unit() {
    let [small, large] = [1e-9, 1e9].map(|unit| iterations(unit, "residual_criterion", true));
    assert!(large < small, "{large} iterations, and {small}");
}
