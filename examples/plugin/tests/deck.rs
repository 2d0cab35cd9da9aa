//! The deck that names all three additions gives the closed form u_y(y) = −p (1/c + y/E).

use std::path::Path;
use std::process::Command;

const STIFFNESS: f64 = 500.0;
const YOUNG: f64 = 1000.0;

fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_zelus-plugin"));
    command.env("NO_COLOR", "1");
    command
}

#[test]
fn a_column_sinks_into_its_foundation() {
    let deck = Path::new(env!("CARGO_MANIFEST_DIR")).join("deck");
    let scratch = tempfile::tempdir().expect("a scratch folder");
    for name in ["ProjectParameters.json", "StructuralMaterials.json", "column.mdpa"] {
        std::fs::copy(deck.join(name), scratch.path().join(name)).expect("a copy of the deck");
    }
    let output = program().args(["run", "ProjectParameters.json"]).current_dir(scratch.path()).output().expect("a run");
    let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{said}");
    assert!(said.contains("energy"), "the criterion judges: {said}");

    let text = std::fs::read_to_string(scratch.path().join("results.json")).expect("results");
    let results: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    for (step, time) in [0.5, 1.0].into_iter().enumerate() {
        let pressure = 40.0 * time;
        for (node, y) in [(1, 0.0), (2, 0.0), (3, 1.0), (4, 1.0), (5, 2.0), (6, 2.0)] {
            let of_node = &results[format!("NODE_{node}")];
            let found = |name: &str| of_node[name][step].as_f64().expect("a number");
            let expected = -pressure * (1.0 / STIFFNESS + y / YOUNG);
            assert!((found("DISPLACEMENT_Y") - expected).abs() < 1e-12, "node {node}: {of_node}, expected {expected}");
            assert!(found("DISPLACEMENT_X").abs() < 1e-12, "node {node}: {of_node}");
        }
    }
}

#[test]
fn the_additions_are_described_like_the_rest() {
    for (name, words) in [
        ("ElasticFoundationCondition2D2N", "springs along a line"),
        ("scale_load_process", "number or function of t"),
        ("energy_criterion", "work of the residual"),
        ("FOUNDATION_STIFFNESS", "force per length cubed"),
    ] {
        let output = program().args(["describe", name]).output().expect("a run");
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success() && said.contains(words), "{name}: {said}");
    }
}
