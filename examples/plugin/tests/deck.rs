//! The decks that name all additions give the closed forms of their problems.

use std::path::Path;
use std::process::Command;

const FOUNDATION: f64 = 500.0;
const YOUNG: f64 = 1000.0;

fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_zelus-plugin"));
    command.env("NO_COLOR", "1");
    command
}

/// Runs a deck in a scratch folder; returns the folder, the results and the output of the program.
fn run(deck: &str) -> (tempfile::TempDir, serde_json::Value, String) {
    let scratch = tempfile::tempdir().expect("a scratch folder");
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("deck");
    for file in std::fs::read_dir(from).expect("the decks").flatten() {
        std::fs::copy(file.path(), scratch.path().join(file.file_name())).expect("a copy of the deck");
    }
    let output = program().args(["run", deck]).current_dir(scratch.path()).output().expect("a run");
    let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{deck}: {said}");
    let text = std::fs::read_to_string(scratch.path().join("results.json")).expect("results");
    (scratch, serde_json::from_str(&text).expect("JSON"), said)
}

fn value(results: &serde_json::Value, node: usize, name: &str, step: usize) -> f64 {
    results[format!("NODE_{node}")][name][step].as_f64().unwrap_or_else(|| panic!("{name} of node {node}: {results}"))
}

/// u_y(y) = −q (1/c + y/E); the spring above takes half of the load p, so that q = p/2.
#[test]
fn a_column_sinks_into_its_foundation() {
    let (scratch, results, said) = run("ProjectParameters.json");
    for word in ["energy", "gauss"] {
        assert!(said.contains(word), "{word} takes part: {said}");
    }
    assert!(!said.contains("nothing reads"), "the solver's own settings are read: {said}");
    for (step, time) in [0.5, 1.0].into_iter().enumerate() {
        let pressure = 0.5 * 40.0 * time;
        for (node, y) in [(1, 0.0), (2, 0.0), (3, 1.0), (4, 1.0), (5, 2.0), (6, 2.0), (7, 2.0)] {
            let expected = -pressure * (1.0 / FOUNDATION + y / YOUNG);
            let found = value(&results, node, "DISPLACEMENT_Y", step);
            assert!((found - expected).abs() < 1e-12, "node {node}: {found}, expected {expected}");
            assert!(value(&results, node, "DISPLACEMENT_X", step).abs() < 1e-12, "node {node} moves aside");
        }
    }
    let table = std::fs::read_to_string(scratch.path().join("tables/Structure_2.csv")).expect("a table of step 2");
    let rows: Vec<&str> = table.lines().collect();
    assert_eq!((rows.len(), rows[0]), (9, "id,x,y,z,DISPLACEMENT_0,DISPLACEMENT_1,DISPLACEMENT_2"));
    assert!(rows[1].starts_with("1,10,"), "the modeler has moved the mesh: {}", rows[1]);
}

/// The way w of the top is shared by two blocks, the lower three times as wide, and the layer: p (1/E + 1/3E + 1/c) = w.
#[test]
fn a_soft_layer_bears_a_block() {
    let (_scratch, results, said) = run("SoftLayer.json");
    assert!(said.contains("gmres"), "the preconditioner is that of gmres: {said}");
    for (step, time) in [0.25, 0.5, 0.75, 1.0].into_iter().enumerate() {
        let pressure = 0.01 * time / (4.0 / (3.0 * YOUNG) + 1.0 / 500.0);
        let below = -pressure / (3.0 * YOUNG);
        for (node, expected) in [(3, below), (4, below), (5, pressure / YOUNG - 0.01 * time)] {
            let found = value(&results, node, "DISPLACEMENT_Y", step);
            assert!((found - expected).abs() < 1e-9, "node {node}: {found}, expected {expected}");
        }
    }
}

/// A block that slides on a rigid one is held by the adhesion 1 of its surface and a fifth of what presses it.
#[test]
fn an_adhesive_surface_holds_a_block() {
    let (_scratch, results, _) = run("Friction.json");
    let sum = |name: &str| [7, 8].into_iter().map(|node| value(&results, node, name, 3)).sum::<f64>();
    let (along, across) = (sum("REACTION_X"), sum("REACTION_Y"));
    let surface = 1.0 + value(&results, 6, "DISPLACEMENT_X", 3) - value(&results, 5, "DISPLACEMENT_X", 3);
    assert!(across < -4.0, "the block is pressed: {across}");
    // the block rests on a penalty, which leaves its surface a slope of 6e-7
    assert!((along - (surface - 0.2 * across)).abs() < 1e-5, "held by {along} under {across}");
}

#[test]
fn the_additions_are_described_like_the_rest() {
    for (name, words) in [
        ("ElasticFoundationCondition2D2N", "springs along a line"),
        ("SmallDisplacementAxialSpringElement2D2N", "AXIAL_STIFFNESS times lengthening"),
        ("MeanConstraint", "the mean of that unknown"),
        ("UncoupledPlaneStress2DLaw", "needs YOUNG_MODULUS"),
        ("Adhesive", "ADHESION and a fifth of the pressure"),
        ("ALMContactSoftLayer", "through a soft layer"),
        ("doubling", "twice the penalty"),
        ("scale_load_process", "number or function of t"),
        ("ShiftMeshModeler", "by how much"),
        ("energy_criterion", "work of the residual"),
        ("continued", "the increment of the last one"),
        ("Continued", "root model part"),
        ("patient_newton", "continues once"),
        ("refining", "corrected once"),
        ("gauss", "elimination"),
        ("jacobi", "inverse of the diagonal"),
        ("csv", "a table of nodes"),
        ("FOUNDATION_STIFFNESS", "force per length cubed"),
    ] {
        let output = program().args(["describe", name]).output().expect("a run");
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success() && said.contains(words), "{name}: {said}");
    }
}
