//! Steps are accepted once the forces on each body are in balance, however unlike the bodies.

use serde_json::{Value, json};

use crate::blocks::{Deck, Joint, Mesh};
use crate::support::{read_json, root, said, scratch_copy, zelus};

/// Stiffness of the punch in that of the pad.
const STIFFER: f64 = 210e3;
/// Share of its height by which the pad is pressed.
const PRESSED: f64 = 0.3;

/// A pad of a neo-Hookean material without lateral contraction, and a punch of the same law that is moved onto it in one step.
/// Gives the report and the messages of the run.
fn press(change: impl FnOnce(&mut Value)) -> (Value, String) {
    let mut mesh = Mesh::new(2);
    let lower = mesh.block("Lower", [6, 4, 0], |x| [2.0 * x[0], x[1], 0.0]);
    let upper = mesh.block("Upper", [4, 2, 0], |x| [2.0 * x[0], 1.0 + x[1], 0.0]);
    let sides = |of: &crate::blocks::Sides, at: (usize, usize)| of[&at].clone();
    let left = [sides(&lower, (0, 0)).0, sides(&upper, (0, 0)).0].concat();
    mesh.part("Left", left, vec![]);
    let (bottom, top) = (sides(&lower, (1, 0)), sides(&upper, (1, 1)));
    mesh.part("Bottom", bottom.0, vec![]);
    mesh.part("Top", top.0, vec![]);
    let (of_pad, of_punch) = (sides(&lower, (1, 1)), sides(&upper, (1, 0)));
    mesh.part("Slave", of_punch.0.clone(), of_punch.1.clone());
    mesh.part("Interface", [of_pad.0, of_punch.0].concat(), [of_pad.1, of_punch.1].concat());
    let held = |c: usize, value: Value| {
        let mut all = [Value::Null, Value::Null, Value::Null];
        all[c] = value;
        all
    };
    let supports = vec![
        ("Left".to_owned(), held(0, json!(0.0))),
        ("Bottom".to_owned(), held(1, json!(0.0))),
        ("Top".to_owned(), held(1, json!(format!("-{PRESSED}*t")))),
    ];
    let deck = Deck { mesh, joint: Joint::Frictionless, supports, pressure: 0.0, young: 1.0, steps: 1 };
    let scratch = tempfile::tempdir().expect("a scratch folder");
    deck.write(scratch.path(), |deck| {
        // The tolerances of the program.
        let solver = deck["solver_settings"].as_object_mut().expect("settings");
        ["residual_relative_tolerance", "residual_absolute_tolerance"].iter().for_each(|key| {
            solver.remove(*key);
        });
        solver["contact_settings"] = json!({"mortar_type": "ALMContactFrictionless"});
        change(deck);
    });
    let materials = ["Lower", "Upper"].into_iter().zip([1.0, STIFFER]).enumerate().map(|(at, (name, young))| {
        json!({"model_part_name": format!("Structure.{name}"), "properties_id": at + 1, "Material": {
            "constitutive_law": {"name": "HyperElasticPlaneStrain2DLaw"},
            "Variables": {"YOUNG_MODULUS": young, "POISSON_RATIO": 0.0}, "Tables": {}}})
    });
    let materials = json!({"properties": materials.collect::<Vec<_>>()});
    std::fs::write(scratch.path().join("StructuralMaterials.json"), materials.to_string()).expect("a file");
    let path = scratch.path().join("mesh.mdpa");
    let text = std::fs::read_to_string(&path).expect("the mesh");
    std::fs::write(&path, text.replace("SmallDisplacementElement", "TotalLagrangianElement")).expect("a file");
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json", "--report", "report.json"]);
    assert!(output.status.success(), "{}", said(&output));
    (read_json(&scratch.path().join("report.json")).expect("the report"), said(&output))
}

/// Share of the forces that the report says is out of balance.
fn out_of_balance(report: &Value) -> f64 {
    report["steps"][0]["balance"]["unknowns"][0]["forces"]["relative"].as_f64().expect("a number")
}

#[test]
fn a_soft_pad_under_a_stiff_punch_is_in_balance() {
    let (report, messages) = press(|_| {});
    let relative = out_of_balance(&report);
    assert!(relative < 1e-4, "out of balance by {relative}");
    assert!(!messages.contains("out-of-balance"), "{messages}");
    // ANALYTIC: σ = E/2 (1/λ − λ) per initial area, λ = 1 − PRESSED; 1e-4 is the tolerance of the residual.
    let stretch = 1.0 - PRESSED;
    let exact = 2.0 * 0.5 * (stretch.recip() - stretch);
    let pair = report["steps"][0]["balance"]["pairs"][0]["force"][1].as_f64().expect("a number").abs();
    assert!((pair - exact).abs() < 2e-4 * exact, "{pair} {exact}");
}

#[test]
fn a_nonlinear_model_in_a_linear_analysis_is_iterated_until_it_is_in_balance() {
    let run = |analysis: &str| {
        let scratch = scratch_copy(&root().join("tests/cases/structural/cooks_membrane_mixed"));
        let path = scratch.path().join("ProjectParameters.json");
        let mut deck = read_json(&path).expect("the deck");
        deck["solver_settings"]["analysis_type"] = json!(analysis);
        std::fs::write(&path, deck.to_string()).expect("a file");
        let output = zelus(scratch.path(), &["run", "ProjectParameters.json", "--report", "report.json"]);
        assert!(output.status.success(), "{}", said(&output));
        let report = read_json(&scratch.path().join("report.json")).expect("the report");
        let last = report["steps"].as_array().expect("steps").last().expect("a step").clone();
        (last["balance"]["energies"]["stored"].as_f64().expect("a number"), said(&output))
    };
    let ((linear, told), (nonlinear, silent)) = (run("linear"), run("non_linear"));
    assert!(told.contains("linear-analysis") && !silent.contains("linear-analysis"), "{told} {silent}");
    assert!((linear - nonlinear).abs() < 1e-6 * nonlinear.abs(), "{linear} {nonlinear}");
}

#[test]
fn a_state_that_only_the_criterion_accepts_is_told() {
    let (report, messages) = press(|deck| deck["solver_settings"]["check_body_balance"] = json!(false));
    assert!(messages.contains("out-of-balance") && messages.contains("part Lower"), "{messages}");
    assert!(out_of_balance(&report) > 0.05, "the deck would need no check");
}
