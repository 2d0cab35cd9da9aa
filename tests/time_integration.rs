//! Time integration against closed forms: ANALYTIC throughout.
//!
//! `tests/decks/oscillator` is one element that swings along x with one free motion: m ü + c u̇ + k u = f, where
//! k = E = 1 and m = ρ/3 (consistent) or ρ/2 (lumped); it starts at u = 0 with velocity 1, so that with m = 1 and no load
//! u = sin t exactly and the first acceleration is 0, as the schemes assume.

mod support;

use support::{Results, change, root, said, scratch_copy, zelus};

/// The oscillator's result after changes of its files.
fn oscillate(changes: &[(&str, &str, &str)], time_step: f64, end_time: f64) -> Results {
    let scratch = scratch_copy(&root().join("tests/decks/oscillator"));
    for (file, find, with) in changes {
        change(scratch.path(), file, find, with);
    }
    let deck = "ProjectParameters.json";
    change(scratch.path(), deck, "\"time_step\": 0.1", &format!("\"time_step\": {time_step:e}"));
    let end = end_time - 0.5 * time_step;
    change(scratch.path(), deck, "\"end_time\": 1.0", &format!("\"end_time\": {end:e}"));
    let output = zelus(scratch.path(), &["run", deck]);
    assert!(output.status.success(), "{}", said(&output));
    Results::read(&scratch.path().join("results.json")).expect("results")
}

fn last(results: &Results, quantity: &str) -> f64 {
    results.nodal(quantity, results.step(None).expect("a step"))[&2]
}

/// Errors of the displacement at `end_time` for steps 0.1, 0.05, 0.025, and the slopes between them.
fn slopes(changes: &[(&str, &str, &str)], exact: f64, end_time: f64) -> ([f64; 3], [f64; 2]) {
    let errors = [0.1, 0.05, 0.025].map(|dt| (last(&oscillate(changes, dt, end_time), "DISPLACEMENT_X") - exact).abs());
    (errors, [(errors[0] / errors[1]).log2(), (errors[1] / errors[2]).log2()])
}

fn assert_order(name: &str, changes: &[(&str, &str, &str)], exact: f64, end_time: f64, order: f64) {
    let (errors, slopes) = slopes(changes, exact, end_time);
    let said = format!("{name}: errors {}, slopes {slopes:.3?}", errors.map(|e| format!("{e:.3e}")).join(" "));
    println!("{said}");
    assert!(slopes.iter().all(|s| (s - order).abs() < 0.12), "{said}");
}

const DECK: &str = "ProjectParameters.json";
const MATERIAL: &str = "StructuralMaterials.json";
const EXPLICIT: [(&str, &str, &str); 3] = [
    (DECK, "\"time_integration_method\": \"implicit\"", "\"time_integration_method\": \"explicit\""),
    (DECK, "\"scheme_type\": \"newmark\"", "\"scheme_type\": \"central_differences\""),
    (MATERIAL, "\"DENSITY\": 3.0", "\"DENSITY\": 2.0"),
];

#[test]
fn central_differences_are_of_second_order() {
    assert_order("central_differences", &EXPLICIT, 2.0_f64.sin(), 2.0, 2.0);
}

/// sin(ω̄ Δt / 2) = ω Δt / 2: the frequency of the discrete motion, without any growth.
#[test]
fn central_differences_swing_with_their_own_frequency_and_keep_the_amplitude() {
    let dt = 0.5;
    let results = oscillate(&EXPLICIT, dt, 200.0);
    let frequency = 2.0 / dt * (0.5 * dt).asin();
    let amplitude = dt / (frequency * dt).sin();
    for step in 0..results.len() {
        let u = results.nodal("DISPLACEMENT_X", step)[&2];
        let exact = amplitude * (frequency * dt * (step + 1) as f64).sin();
        assert!((u - exact).abs() < 1e-10, "step {step}: {u} instead of {exact}");
    }
}

/// ω = 1, so that the critical step is 2; a predicted step is 0.8 of an estimate at most 1 % below.
#[test]
fn the_critical_step_is_known() {
    let mut changes = EXPLICIT.to_vec();
    changes.push((
        DECK,
        "\"rayleigh_alpha\": 0.0",
        "\"time_step_prediction_level\": 1, \"max_delta_time\": 9.0, \"rayleigh_alpha\": 0.0",
    ));
    let results = oscillate(&changes, 0.1, 100.0);
    let step = results.times()[0];
    assert!((1.57..=1.6).contains(&step), "the predicted step is {step}");
    let scratch = scratch_copy(&root().join("tests/decks/oscillator"));
    for (file, find, with) in EXPLICIT {
        change(scratch.path(), file, find, with);
    }
    change(scratch.path(), DECK, "\"time_step\": 0.1", "\"time_step\": 2.1");
    let output = zelus(scratch.path(), &["run", DECK]);
    assert!(said(&output).contains("critical-step"), "{}", said(&output));
    change(scratch.path(), DECK, "\"end_time\": 1.0", "\"end_time\": 1e4");
    let output = zelus(scratch.path(), &["run", DECK]);
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
    assert!(said(&output).contains("of node") && said(&output).contains("critical"), "{}", said(&output));
}

#[test]
fn explicit_steps_hold_prescribed_motion_unless_told() {
    let mut changes = EXPLICIT.to_vec();
    let still = "\"constrained\": [true, true, true], \"value\": [0.0, 0.0, 0.0]";
    let moved = "\"constrained\": [true, true, true], \"value\": [\"0.25*t\", 0.0, 0.0]";
    changes.push((DECK, still, moved));
    let held = oscillate(&changes, 0.05, 1.0);
    assert_eq!(held.nodal("DISPLACEMENT_X", 0)[&1], 0.0);
    assert!((last(&held, "DISPLACEMENT_X") - 1.0_f64.sin()).abs() < 1e-3);
    changes.push((DECK, "\"rayleigh_alpha\": 0.0", "\"follow_prescribed_motion\": true, \"rayleigh_alpha\": 0.0"));
    let followed = oscillate(&changes, 0.05, 1.0);
    let end = followed.step(None).expect("a step");
    assert!((followed.nodal("DISPLACEMENT_X", end)[&1] - 0.25).abs() < 1e-12);
    // With the wall at t/4, w = u − t/4 swings from rest position with velocity 3/4.
    let exact = 0.25 + 0.75 * 1.0_f64.sin();
    assert!((last(&followed, "DISPLACEMENT_X") - exact).abs() < 1e-3, "{} {exact}", last(&followed, "DISPLACEMENT_X"));
}
