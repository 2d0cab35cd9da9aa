//! Masses, springs and dampers at nodes, and bars, in whole decks.

use std::fmt::Write as _;

use serde_json::{Value, json};
use zelus::{RunOptions, Silent, Simulation};

/// Runs a deck of a mesh given as text; the histories of its nodes.
fn run(mesh: &str, materials: &Value, solver: Value, processes: Value, end_time: f64) -> Value {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let mut settings = json!({
        "model_part_name": "Structure", "domain_size": 3, "echo_level": 0, "analysis_type": "non_linear",
        "model_import_settings": {"input_type": "mdpa", "input_filename": "mesh"},
        "material_import_settings": {"materials_filename": "materials.json"},
        "convergence_criterion": "residual_criterion", "residual_relative_tolerance": 1e-10,
        "residual_absolute_tolerance": 1e-12, "max_iteration": 20});
    let more = solver.as_object().expect("an object");
    more.iter().for_each(|(key, value)| settings[key] = value.clone());
    let mut list = processes.as_array().expect("a list").clone();
    list.push(json!({"python_module": "json_output_process", "kratos_module": "KratosMultiphysics", "Parameters": {
        "output_file_name": "results.json", "model_part_name": "Structure", "time_frequency": 0.0,
        "output_variables": ["DISPLACEMENT", "REACTION"]}}));
    let deck = json!({
        "problem_data": {"problem_name": "springs", "parallel_type": "OpenMP", "start_time": 0.0, "end_time": end_time},
        "solver_settings": settings, "processes": {"list": list}});
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file");
    write("ProjectParameters.json", &deck.to_string());
    write("materials.json", &materials.to_string());
    write("mesh.mdpa", mesh);
    let path = folder.path().join("ProjectParameters.json");
    let opened = Simulation::open(&path, &RunOptions::default());
    let result = opened.and_then(|mut simulation| simulation.run(&mut Silent));
    result.unwrap_or_else(|problem| panic!("{problem}"));
    serde_json::from_str(&std::fs::read_to_string(folder.path().join("results.json")).expect("results")).expect("JSON")
}

fn mesh(nodes: &[[f64; 3]], blocks: &str) -> String {
    let mut out = String::from("Begin Properties 0\nEnd Properties\nBegin Nodes\n");
    for (at, x) in nodes.iter().enumerate() {
        let _ = writeln!(out, "{} {} {} {}", at + 1, x[0], x[1], x[2]);
    }
    out + "End Nodes\n" + blocks
}

fn fix(part: &str, value: Value) -> Value {
    let constrained: Vec<bool> = value.as_array().expect("a list").iter().map(|v| !v.is_null()).collect();
    json!({"python_module": "assign_vector_variable_process", "kratos_module": "KratosMultiphysics", "Parameters": {
        "model_part_name": format!("Structure.{part}"), "variable_name": "DISPLACEMENT", "constrained": constrained,
        "value": value, "interval": [0.0, "End"]}})
}

/// A mass on a spring with a damper, let go under gravity: u = mg/k (1 − e^(−ζωt) (cos ω_d t + ζω/ω_d sin ω_d t)).
/// Newmark's scheme with 200 steps a period leaves 2e-3 of the static sag. Constants of the element's own data, then of
/// the properties.
#[test]
fn a_damped_oscillator() {
    let (mass, stiffness, damping, gravity) = (2.0_f64, 50.0_f64, 3.0_f64, 9.81_f64);
    let omega = (stiffness / mass).sqrt();
    let zeta = damping / (2.0 * mass * omega);
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    let own = "Begin Elements NodalConcentratedElement3D1N\n1 0 1\nEnd Elements\n\
        Begin ElementalData NODAL_MASS\n1 2.0\nEnd ElementalData\n\
        Begin ElementalData NODAL_DISPLACEMENT_STIFFNESS\n1 [3] (0.0, 0.0, 50.0)\nEnd ElementalData\n\
        Begin ElementalData NODAL_DAMPING_RATIO\n1 [3] (0.0, 0.0, 3.0)\nEnd ElementalData\n";
    let shared = "Begin Elements NodalConcentratedDampedElement3D1N\n1 0 1\nEnd Elements\n";
    let parts = "Begin SubModelPart Mass\nBegin SubModelPartNodes\n1\nEnd SubModelPartNodes\nEnd SubModelPart\n";
    let values = json!({"NODAL_MASS": mass, "NODAL_DISPLACEMENT_STIFFNESS": [0.0, 0.0, stiffness],
        "NODAL_DAMPING_RATIO": [0.0, 0.0, damping]});
    for (blocks, variables) in [(own, json!({})), (shared, values)] {
        let text = mesh(&[[0.0; 3]], &format!("{blocks}{parts}"));
        let materials = json!({"properties": [{"model_part_name": "Structure", "properties_id": 1, "Material": {
            "Variables": variables, "Tables": {}}}]});
        let step = 2.0 * std::f64::consts::PI / omega / 200.0;
        let solver = json!({"solver_type": "Dynamic", "time_integration_method": "implicit", "scheme_type": "newmark",
            "time_stepping": {"time_step": step}});
        let processes = json!([fix("Mass", json!([0.0, 0.0, null])),
            {"python_module": "assign_vector_by_direction_process", "kratos_module": "KratosMultiphysics", "Parameters": {
                "model_part_name": "Structure.Mass", "variable_name": "VOLUME_ACCELERATION", "modulus": gravity,
                "direction": [0.0, 0.0, -1.0], "constrained": false, "interval": [0.0, "End"]}}]);
        let results = run(&text, &materials, solver, processes, 400.0 * step);
        let sag = mass * gravity / stiffness;
        let times = results["TIME"].as_array().expect("TIME");
        let found = results["NODE_1"]["DISPLACEMENT_Z"].as_array().expect("a history");
        assert!(times.len() >= 400);
        let mut worst = 0.0_f64;
        for (t, u) in times.iter().zip(found) {
            let (t, u) = (t.as_f64().expect("a time"), u.as_f64().expect("a number"));
            let wave = (damped * t).cos() + zeta * omega / damped * (damped * t).sin();
            worst = worst.max((u + sag * (1.0 - (-zeta * omega * t).exp() * wave)).abs());
        }
        // the scheme starts without the acceleration that the load has at once, half a step late
        println!("largest difference {:.2e} of the sag", worst / sag);
        assert!(worst < 2.5e-2 * sag, "{worst} of {sag}");
    }
}

/// Two springs in a row, pulled by 0.3: the node between goes k_1/(k_1 + k_2) of the way from the second's far end.
#[test]
fn springs_in_a_row() {
    let text = mesh(
        &[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
        "Begin Elements SpringDamperElement3D2N\n1 0 1 2\n2 0 2 3\nEnd Elements\n\
         Begin ElementalData NODAL_DISPLACEMENT_STIFFNESS\n1 [3] (10.0, 1.0, 1.0)\n2 [3] (30.0, 1.0, 1.0)\nEnd ElementalData\n\
         Begin SubModelPart Ground\nBegin SubModelPartNodes\n1\nEnd SubModelPartNodes\nEnd SubModelPart\n\
         Begin SubModelPart Far\nBegin SubModelPartNodes\n3\nEnd SubModelPartNodes\nEnd SubModelPart\n",
    );
    let materials = json!({"properties": [{"model_part_name": "Structure", "properties_id": 1, "Material": {
        "Variables": {}, "Tables": {}}}]});
    let solver = json!({"solver_type": "Static", "time_stepping": {"time_step": 1.0}});
    let processes = json!([fix("Ground", json!([0.0, 0.0, 0.0])), fix("Far", json!([0.3, 0.0, 0.0]))]);
    let results = run(&text, &materials, solver, processes, 1.0);
    let middle = results["NODE_2"]["DISPLACEMENT_X"][0].as_f64().expect("a number");
    assert!((middle - 0.3 * 30.0 / 40.0).abs() < 1e-12, "{middle}");
    let pull = results["NODE_3"]["REACTION_X"][0].as_f64().expect("a number");
    assert!((pull - 0.3 * 7.5).abs() < 1e-12, "{pull}");
}

/// Two bars in a shallow roof pressed at the ridge through its snap: f = 2 A E ((l/l_0)² − 1)/2 · z/l_0 at height z.
#[test]
fn a_shallow_roof_of_two_bars() {
    let (rise, young, area) = (0.1_f64, 1000.0_f64, 0.5_f64);
    let text = mesh(
        &[[-1.0, 0.0, 0.0], [0.0, 0.0, rise], [1.0, 0.0, 0.0]],
        "Begin Elements TrussElement3D2N\n1 0 1 2\n2 0 2 3\nEnd Elements\n\
         Begin SubModelPart Ground\nBegin SubModelPartNodes\n1\n3\nEnd SubModelPartNodes\nEnd SubModelPart\n\
         Begin SubModelPart Ridge\nBegin SubModelPartNodes\n2\nEnd SubModelPartNodes\nEnd SubModelPart\n",
    );
    let materials = json!({"properties": [{"model_part_name": "Structure", "properties_id": 1, "Material": {
        "constitutive_law": {"name": "TrussConstitutiveLaw"},
        "Variables": {"YOUNG_MODULUS": young, "CROSS_AREA": area}, "Tables": {}}}]});
    let solver = json!({"solver_type": "Static", "time_stepping": {"time_step": 0.25}});
    let processes = json!([fix("Ground", json!([0.0, 0.0, 0.0])), fix("Ridge", json!([null, 0.0, "-0.2*t"]))]);
    let results = run(&text, &materials, solver, processes, 1.0);
    let square = 1.0 + rise * rise;
    for (step, t) in [0.25, 0.5, 0.75, 1.0].into_iter().enumerate() {
        let height = rise - 0.2 * t;
        let strain = 0.5 * ((1.0 + height * height) / square - 1.0);
        let expected = 2.0 * area * young * strain * height / square.sqrt();
        let found = results["NODE_2"]["REACTION_Z"][step].as_f64().expect("a number");
        assert!((found - expected).abs() < 1e-10 * area * young, "{t}: {found} {expected}");
    }
}

/// Two bars in a row between walls, the first hot: their force is −A E α ΔT/2; both hot, they yield. Under finite strain a bar that is free
/// is longer by θ, and one that is held at its length is under S = θ E (1 − θ²)/2θ².
#[test]
fn bars_expand() {
    let (young, area, expansion, rise) = (1000.0_f64, 0.5_f64, 1e-3, 40.0);
    let text = |element: &str| {
        mesh(
            &[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
            &format!(
                "Begin Elements {element}\n1 0 1 2\n2 0 2 3\nEnd Elements\n\
                 Begin SubModelPart Left\nBegin SubModelPartNodes\n1\nEnd SubModelPartNodes\nEnd SubModelPart\n\
                 Begin SubModelPart Middle\nBegin SubModelPartNodes\n2\nEnd SubModelPartNodes\nEnd SubModelPart\n\
                 Begin SubModelPart Right\nBegin SubModelPartNodes\n3\nEnd SubModelPartNodes\nEnd SubModelPart\n"
            ),
        )
    };
    let solver = json!({"solver_type": "Static", "time_stepping": {"time_step": 1.0}, "auxiliary_variables_list": ["TEMPERATURE"]});
    let warm = |part: &str, temperature: f64| {
        json!({"python_module": "assign_scalar_variable_process", "Parameters": {"model_part_name": format!("Structure.{part}"),
            "variable_name": "TEMPERATURE", "value": temperature, "constrained": false}})
    };
    let found = |element: &str, law: &str, temperatures: [f64; 3], right: Value| {
        let materials = json!({"properties": [{"model_part_name": "Structure", "properties_id": 1, "Material": {
            "constitutive_law": {"name": law}, "Variables": {"YOUNG_MODULUS": young, "CROSS_AREA": area, "YIELD_STRESS": 8.0,
                "HARDENING_MODULUS_1D": 100.0, "THERMAL_EXPANSION_COEFFICIENT": expansion, "REFERENCE_TEMPERATURE": 20.0},
            "Tables": {}}}]});
        let parts = ["Left", "Middle", "Right"];
        let mut processes: Vec<Value> =
            parts.into_iter().zip(temperatures).map(|(part, t)| warm(part, 20.0 + t)).collect();
        processes.push(fix("Left", json!([0.0, 0.0, 0.0])));
        processes.push(fix("Middle", json!([null, 0.0, 0.0])));
        processes.push(fix("Right", right));
        let results = run(&text(element), &materials, solver.clone(), json!(processes), 1.0);
        let number = |node: usize, what: &str| results[format!("NODE_{node}")][what][0].as_f64().expect("a number");
        [number(2, "DISPLACEMENT_X"), number(3, "DISPLACEMENT_X"), number(3, "REACTION_X")]
    };
    let near = |found: f64, exact: f64, what: &str| {
        assert!((found - exact).abs() < 1e-9 * exact.abs(), "{what}: {found} {exact}")
    };
    let still = || json!([0.0, 0.0, 0.0]);
    for element in ["TrussLinearElement3D2N", "TrussElement3D2N"] {
        let theta = 1.0 + expansion * rise;
        let [middle, end, _] = found(element, "ThermalTrussConstitutiveLaw", [rise; 3], json!([null, 0.0, 0.0]));
        near(middle, theta - 1.0, element);
        near(end, 2.0 * (theta - 1.0), element);
        let [_, _, force] = found(element, "ThermalTrussConstitutiveLaw", [rise; 3], still());
        let small = element.contains("Linear");
        let stress = if small { young * (1.0 - theta) } else { young * (1.0 - theta * theta) / (2.0 * theta) };
        near(force, area * stress, element);
        let [_, _, yielding] = found(element, "ThermalTrussPlasticityConstitutiveLaw", [rise; 3], still());
        let held = if small { theta - 1.0 } else { (theta * theta - 1.0) / (2.0 * theta * theta) };
        let bound = 8.0 + 100.0 * (young * held - 8.0) / (young + 100.0);
        near(yielding, -area * bound * if small { 1.0 } else { theta }, element);
    }
    let [middle, _, force] = found("TrussLinearElement3D2N", "ThermalTrussConstitutiveLaw", [rise, 0.0, 0.0], still());
    near(middle, 0.25 * expansion * rise, "the mean of both ends");
    near(force, -0.25 * area * young * expansion * rise, "the mean of both ends");
}
