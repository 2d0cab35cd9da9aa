//! `alm_variables_calculation_process`: contact takes its numbers like manual ones.
//!
//! The slave side has E = 1e9 and cells of 0.2, the master side E = 2e9 and cells of 1/3: E/h is 5e9 and 6e9, and the smaller
//! counts (eq. 4.11).

use crate::support::root;
use serde_json::{Value, json};
use zelus::{RunOptions, Silent, Simulation};

/// Result of a run: penalty, scale factor, displacements and multipliers.
#[derive(Debug, PartialEq)]
struct Answer {
    penalty: f64,
    scale_factor: f64,
    displacements: Vec<f64>,
    multipliers: Vec<f64>,
}

/// Runs two blocks in contact with these `advance_ALM_parameters` and the settings of the calculation, where there is one.
fn answer(parameters: Value, calculation: Option<Value>) -> Answer {
    let folder = root().join("tests/cases/contact_2d/nonmatching");
    let text = std::fs::read_to_string(folder.join("ProjectParameters.json")).expect("the deck");
    let mut deck: Value = serde_json::from_str(&text).expect("JSON");
    let processes = deck["processes"].as_object_mut().expect("lists");
    processes.remove("json_output_process_list");
    let contact = &mut processes["contact_process_list"][0]["Parameters"];
    contact["augmentation"] = json!("pair");
    contact["advance_ALM_parameters"] = parameters;
    if let Some(settings) = calculation {
        let process = json!({ "python_module": "ALMVariablesCalculationProcess", "Parameters": settings });
        processes.insert("calculation_process_list".to_owned(), json!([process]));
    }
    let options = RunOptions { threads: Some(1), ..RunOptions::default() };
    let mut simulation = Simulation::of_value(&deck, &folder, &options).expect("a deck");
    assert!(simulation.step(&mut Silent).expect("a step"));
    let info = &simulation.part().expect("a stage").info;
    let field = |name: &str| simulation.field(name).expect("a field").to_vec();
    Answer {
        penalty: info.value_or("INITIAL_PENALTY", 0.0),
        scale_factor: info.value_or("SCALE_FACTOR", 0.0),
        displacements: field("DISPLACEMENT"),
        multipliers: field("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE"),
    }
}

fn assert_near(answer: &Answer, penalty: f64, scale_factor: f64) {
    let near = |found: f64, wanted: f64| (found - wanted).abs() <= 1e-9 * wanted;
    let fits = near(answer.penalty, penalty) && near(answer.scale_factor, scale_factor);
    assert!(fits, "ε = {}, k = {}, expected {penalty} and {scale_factor}", answer.penalty, answer.scale_factor);
}

fn manual(penalty: f64, scale_factor: f64) -> Value {
    json!({ "manual_ALM": true, "penalty": penalty, "scale_factor": scale_factor })
}

#[test]
fn the_softer_side_gives_penalty_and_scale_factor() {
    let usual = answer(json!({}), Some(json!({ "model_part_name": "Structure.Interface" })));
    assert_near(&usual, 5e10, 5e10);
    let factors =
        json!({ "model_part_name": "Structure.Interface", "stiffness_factor": 3.0, "penalty_scale_factor": 2.0 });
    assert_near(&answer(json!({}), Some(factors)), 1.5e10, 3e10);
    // Faces of one side alone.
    let masters = json!({ "model_part_name": "Structure.Lower", "stiffness_factor": 1.0 });
    assert_near(&answer(json!({}), Some(masters)), 6e9, 6e9);
    let slaves = json!({ "model_part_name": "Structure.Slave", "stiffness_factor": 1.0 });
    assert_near(&answer(json!({}), Some(slaves)), 5e9, 5e9);
}

#[test]
fn contact_takes_calculated_numbers_like_manual_ones() {
    let factors =
        json!({ "model_part_name": "Structure.Interface", "stiffness_factor": 3.0, "penalty_scale_factor": 2.0 });
    let calculated = answer(json!({}), Some(factors));
    assert_eq!(calculated, answer(manual(calculated.penalty, calculated.scale_factor), None));
    assert!(calculated.multipliers.iter().any(|multiplier| *multiplier < 0.0), "nothing is in contact");
    assert_ne!(calculated.multipliers, answer(json!({}), None).multipliers);
}

#[test]
fn numbers_that_are_not_computed_stay_those_of_contact() {
    let calculation = |of: [bool; 2]| {
        Some(
            json!({ "model_part_name": "Structure.Interface", "compute_penalty": of[0], "compute_scale_factor": of[1] }),
        )
    };
    assert_near(&answer(manual(7e9, 3e9), calculation([false, true])), 7e9, 5e10);
    assert_near(&answer(manual(7e9, 3e9), calculation([true, false])), 5e10, 3e9);
    let neither = answer(manual(7e9, 3e9), calculation([false, false]));
    assert_eq!(neither, answer(manual(7e9, 3e9), None));
}
