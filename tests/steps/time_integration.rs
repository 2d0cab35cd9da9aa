//! Time integration against closed forms: ANALYTIC throughout.
//!
//! `tests/decks/oscillator` is one element that swings along x with one free motion: m ü + c u̇ + k u = f, where
//! k = E = 1 and m = ρ/3 (consistent) or ρ/2 (lumped); it starts at u = 0 with velocity 1, so that with m = 1 and no load
//! u = sin t exactly and the first acceleration is 0, as the schemes assume.

use crate::support::{Results, change, root, said, scratch_copy, zelus};
use std::collections::BTreeMap;

/// The oscillator's result after changes of its files.
fn oscillate(changes: &[(&str, &str, &str)], time_step: f64, end_time: f64) -> Results {
    let scratch = scratch_copy(&root().join("tests/decks/oscillator"));
    for (file, find, with) in changes {
        change(scratch.path(), file, find, with);
    }
    let deck = "ProjectParameters.json";
    change(scratch.path(), deck, "\"time_step\": 0.1", &format!("\"time_step\": {time_step:e}"));
    change(scratch.path(), deck, "\"end_time\": 1.0", &format!("\"end_time\": {end_time:e}"));
    let output = zelus(scratch.path(), &["run", deck]);
    assert!(output.status.success(), "{}", said(&output));
    Results::read(&scratch.path().join("results.json")).expect("results")
}

fn last(results: &Results, quantity: &str) -> f64 {
    results.nodal(quantity, results.step(None).expect("a step"))[&2]
}

/// The exact end of a motion: displacement, and velocity where the scheme gives it at the same time.
type End = (f64, Option<f64>);

/// Errors at `end_time` for steps 0.05, 0.025, 0.0125, and the slopes between them.
fn slopes(changes: &[(&str, &str, &str)], exact: End, end_time: f64) -> ([f64; 3], [f64; 2]) {
    let errors = [0.05, 0.025, 0.0125].map(|dt| {
        let results = oscillate(changes, dt, end_time);
        let velocity = exact.1.map_or(0.0, |v| last(&results, "VELOCITY_X") - v);
        (last(&results, "DISPLACEMENT_X") - exact.0).hypot(velocity)
    });
    (errors, [(errors[0] / errors[1]).log2(), (errors[1] / errors[2]).log2()])
}

fn assert_order(name: &str, changes: &[(&str, &str, &str)], exact: End, end_time: f64, order: f64) {
    let (errors, slopes) = slopes(changes, exact, end_time);
    let said = format!("{name}: errors {}, slopes {slopes:.3?}", errors.map(|e| format!("{e:.3e}")).join(" "));
    println!("{said}");
    assert!(slopes.iter().all(|s| (s - order).abs() < 0.12), "{said}");
}

/// u = sin t at t = 2.
fn free_end() -> End {
    (2.0_f64.sin(), Some(2.0_f64.cos()))
}

const DECK: &str = "ProjectParameters.json";
const MATERIAL: &str = "StructuralMaterials.json";
const EXPLICIT: [(&str, &str, &str); 3] = [
    (DECK, "\"time_integration_method\": \"implicit\"", "\"time_integration_method\": \"explicit\""),
    (DECK, "\"scheme_type\": \"newmark\"", "\"scheme_type\": \"central_differences\""),
    (MATERIAL, "\"DENSITY\": 3.0", "\"DENSITY\": 2.0"),
];

/// The deck with another implicit scheme.
fn scheme(text: &'static str) -> Vec<(&'static str, &'static str, &'static str)> {
    vec![(DECK, "\"scheme_type\": \"newmark\"", text)]
}

const NEWMARK: &str = "\"scheme_type\": \"newmark\"";
const BOSSAK: &str = "\"scheme_type\": \"bossak\", \"damp_factor_m\": -0.3";
const ALPHA: &str = "\"scheme_type\": \"generalized_alpha\", \"rho_inf\": 0.8";
const EULER: &str = "\"scheme_type\": \"backward_euler\"";
const BDF2: &str = "\"scheme_type\": \"bdf2\"";

#[test]
fn implicit_schemes_are_of_their_order() {
    for (name, text, order) in [
        ("newmark", NEWMARK, 2.0),
        ("bossak", BOSSAK, 2.0),
        ("generalized_alpha", ALPHA, 2.0),
        ("backward_euler", EULER, 1.0),
        ("bdf2", BDF2, 2.0),
    ] {
        assert_order(name, &scheme(text), free_end(), 2.0, order);
    }
}

/// u = t⁶ under f = 30 t⁴ + t⁶ begins so smoothly that the made-up past is exact to the order of every scheme.
#[test]
fn forced_motion_shows_the_order_of_all_backward_differences() {
    let load = "0.5*(30.0*t^4 + t^6)";
    for (text, order) in [
        (NEWMARK, 2.0),
        (ALPHA, 2.0),
        ("\"scheme_type\": \"bdf1\"", 1.0),
        (BDF2, 2.0),
        ("\"scheme_type\": \"bdf3\"", 3.0),
        ("\"scheme_type\": \"bdf4\"", 4.0),
        ("\"scheme_type\": \"bdf5\"", 5.0),
    ] {
        let mut changes = scheme(text);
        changes.push((DECK, "0.0*t", load));
        changes.push(("mesh.mdpa", "2 0 1.0\n3 0 1.0", "2 0 0.0\n3 0 0.0"));
        let slopes = slopes(&changes, (1.0, Some(6.0)), 1.0);
        println!("{text}: errors {:?}, slopes {:?}", slopes.0, slopes.1);
        assert!((slopes.1[1] - order).abs() < 0.25, "{text}: {slopes:?}");
    }
}

/// c u̇ + u = c with c = α + β, at rest at first but for the velocity 1 that is in balance: u = c (1 − e^{−t/c}).
#[test]
fn pseudo_static_motion_creeps_to_rest_in_second_order() {
    let c: f64 = 0.3;
    let fall = (-1.0 / c).exp();
    let mut changes = scheme("\"scheme_type\": \"pseudo_static\"");
    changes.push((
        DECK,
        "\"rayleigh_alpha\": 0.0, \"rayleigh_beta\": 0.0",
        "\"rayleigh_alpha\": 0.2, \"rayleigh_beta\": 0.1",
    ));
    changes.push((DECK, "0.0*t", "0.5*0.3"));
    assert_order("pseudo_static", &changes, (c * (1.0 - fall), Some(fall)), 1.0, 2.0);
    // without damping each step is in equilibrium at once
    let mut still = scheme("\"scheme_type\": \"pseudo_static\"");
    still.push((DECK, "0.0*t", "0.5*t"));
    let results = oscillate(&still, 0.1, 1.0);
    for step in 0..results.len() {
        let (u, time) = (results.nodal("DISPLACEMENT_X", step)[&2], results.times()[step]);
        assert!((u - time).abs() < 1e-9, "at {time}: {u}");
    }
}

/// One step of generalised-α (Bossak and Newmark with `f` = 0) for ü + u = 0, from (u, v, a).
fn step_alpha([u, v, a]: [f64; 3], dt: f64, m: f64, f: f64) -> [f64; 3] {
    let (gamma, beta) = (0.5 - m + f, 0.25 * (1.0 - m + f).powi(2));
    let guess = u + dt * v + dt * dt * (0.5 - beta) * a;
    let next = -(m * a + (1.0 - f) * guess + f * u) / (1.0 - m + (1.0 - f) * beta * dt * dt);
    [guess + dt * dt * beta * next, v + dt * ((1.0 - gamma) * a + gamma * next), next]
}

/// Sixteen periods of free vibration: each scheme gives its own discrete motion, and the energy that belongs to it.
#[test]
fn free_vibration_follows_the_discrete_motion_of_each_scheme() {
    let (dt, end) = (0.1, 100.0);
    let rho: f64 = 0.8;
    for (name, text, m, f) in [
        ("newmark", NEWMARK, 0.0, 0.0),
        ("bossak", BOSSAK, -0.3, 0.0),
        ("generalized_alpha", ALPHA, (2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0)),
    ] {
        let results = oscillate(&scheme(text), dt, end);
        let mut state = [0.0, 1.0, 0.0];
        for step in 0..results.len() {
            state = step_alpha(state, dt, m, f);
            for (quantity, exact) in ["DISPLACEMENT_X", "VELOCITY_X", "ACCELERATION_X"].into_iter().zip(state) {
                let found = results.nodal(quantity, step)[&2];
                assert!((found - exact).abs() < 1e-9, "{name}, step {step}: {quantity} {found} instead of {exact}");
            }
        }
        let energy = state[0].powi(2) + state[1].powi(2);
        println!("{name}: energy after {} steps of {dt}: {:.6} of the first", results.len(), energy);
        assert!(if name == "newmark" { (energy - 1.0).abs() < 1e-9 } else { energy < 1.0 }, "{name}: {energy}");
    }
    for (name, text) in [("backward_euler", EULER), ("bdf2", BDF2)] {
        let results = oscillate(&scheme(text), dt, end);
        let energy = last(&results, "DISPLACEMENT_X").powi(2) + last(&results, "VELOCITY_X").powi(2);
        // |z|² of y' = i y a step: Euler's 1/(1 + Δt²); for two differences, the root of (3/2 − iΔt) z² − 2z + 1/2.
        let exact = if name == "bdf2" { bdf2_modulus(dt) } else { 1.0 / (1.0 + dt * dt) };
        let exact = exact.powi(results.len() as i32);
        println!("{name}: energy after {} steps of {dt}: {energy:.6} of the first", results.len());
        assert!((energy / exact - 1.0).abs() < 0.02, "{name}: {energy} instead of {exact}");
    }
}

/// |z|² of the principal root z = (2 + √(1 + 2iΔt))/(3 − 2iΔt).
fn bdf2_modulus(dt: f64) -> f64 {
    let size = (1.0 + 4.0 * dt * dt).sqrt();
    let (re, im) = (2.0 + (0.5 * (size + 1.0)).sqrt(), (0.5 * (size - 1.0)).sqrt());
    (re * re + im * im) / (9.0 + 4.0 * dt * dt)
}

/// ü + c u̇ + u = 0 with c = α + β: u = e^{−ct/2} sin(ωt)/ω, ω² = 1 − c²/4; the first acceleration is −c.
#[test]
fn rayleigh_damping_comes_from_the_solver_or_from_the_properties() {
    let c: f64 = 0.3;
    let omega = (1.0 - 0.25 * c * c).sqrt();
    let (sin, cos) = (2.0 * omega).sin_cos();
    let exact = ((-c).exp() * sin / omega, Some((-c).exp() * (cos - 0.5 * c * sin / omega)));
    let begin = (
        "mesh.mdpa",
        "Begin SubModelPart Body",
        "Begin NodalData ACCELERATION_X\n2 0 -0.3\n3 0 -0.3\nEnd NodalData\n\nBegin SubModelPart Body",
    );
    let solver =
        [(DECK, "\"rayleigh_alpha\": 0.0, \"rayleigh_beta\": 0.0", "\"rayleigh_alpha\": 0.2, \"rayleigh_beta\": 0.1")];
    let properties = [
        (DECK, "\"rayleigh_alpha\": 0.0, \"rayleigh_beta\": 0.0", "\"rayleigh_alpha\": 9.0, \"rayleigh_beta\": 9.0"),
        (MATERIAL, "\"DENSITY\": 3.0", "\"DENSITY\": 3.0, \"RAYLEIGH_ALPHA\": 0.2, \"RAYLEIGH_BETA\": 0.1"),
    ];
    for (name, text) in [("newmark", NEWMARK), ("bossak", BOSSAK), ("generalized_alpha", ALPHA), ("bdf2", BDF2)] {
        let by_solver: Vec<_> = scheme(text).into_iter().chain(solver).chain([begin]).collect();
        assert_order(&format!("{name}, damped"), &by_solver, exact, 2.0, 2.0);
        let by_properties: Vec<_> = scheme(text).into_iter().chain(properties).chain([begin]).collect();
        let ends = [by_solver, by_properties].map(|changes| oscillate(&changes, 0.1, 2.0));
        for quantity in ["DISPLACEMENT_X", "VELOCITY_X", "REACTION_X"] {
            let [a, b] = [0, 1].map(|i| last(&ends[i], quantity));
            assert!((a - b).abs() < 1e-12, "{name}: {quantity} {a} by the solver, {b} by the properties");
        }
    }
}

/// One element in uniform strain: with VOLUMETRIC_STRAIN at its nodes it swings as the one of displacements alone does.
///
/// Where damping goes with the stiffness, VOLUMETRIC_STRAIN is that of u + β v: its stress has the damping in it.
#[test]
fn volumetric_strain_at_the_nodes_moves_with_every_implicit_scheme() {
    let mixed = [
        ("mesh.mdpa", "SmallDisplacementElement2D4N", "SmallDisplacementMixedVolumetricStrainElement2D4N"),
        (DECK, "\"time_stepping\"", "\"volumetric_strain_dofs\": true, \"time_stepping\""),
        (DECK, "\"DISPLACEMENT\", \"VELOCITY\"", "\"VOLUMETRIC_STRAIN\", \"DISPLACEMENT\", \"VELOCITY\""),
    ];
    let damped =
        (DECK, "\"rayleigh_alpha\": 0.0, \"rayleigh_beta\": 0.0", "\"rayleigh_alpha\": 0.2, \"rayleigh_beta\": 0.1");
    let by_properties =
        (MATERIAL, "\"DENSITY\": 3.0", "\"DENSITY\": 3.0, \"RAYLEIGH_ALPHA\": 0.2, \"RAYLEIGH_BETA\": 0.1");
    let lumped = (MATERIAL, "\"DENSITY\": 3.0", "\"DENSITY\": 2.0, \"COMPUTE_LUMPED_MASS_MATRIX\": true");
    let euler =
        ["bdf1", "bdf2", "bdf3", "bdf4", "bdf5", "pseudo_static"].map(|name| format!("\"scheme_type\": \"{name}\""));
    for text in [NEWMARK, BOSSAK, ALPHA].into_iter().chain(euler.iter().map(String::as_str)) {
        for (more, beta) in [(None, 0.0), (Some(lumped), 0.0), (Some(damped), 0.1), (Some(by_properties), 0.1)] {
            if text.contains("pseudo_static") && beta == 0.0 {
                continue;
            }
            let plain: Vec<_> = std::iter::once((DECK, NEWMARK, text)).chain(more).collect();
            let changes: Vec<_> = plain.iter().copied().chain(mixed).collect();
            let [plain, found] = [plain, changes].map(|changes| oscillate(&changes, 0.1, 3.0));
            for step in 0..plain.len() {
                for quantity in ["DISPLACEMENT_X", "VELOCITY_X", "ACCELERATION_X", "REACTION_X"] {
                    let [a, b] = [&plain, &found].map(|results| results.nodal(quantity, step)[&2]);
                    assert!((a - b).abs() < 1e-9, "{text}, {more:?}, step {step}: {quantity} {b} instead of {a}");
                }
                let of = |quantity| found.nodal(quantity, step)[&2];
                let strain = of("DISPLACEMENT_X") + beta * of("VELOCITY_X");
                assert!((of("VOLUMETRIC_STRAIN") - strain).abs() < 1e-9, "{text}, {more:?}, step {step}: {strain}");
            }
        }
    }
}

#[test]
fn a_lumped_mass_comes_from_the_properties() {
    let lumped = (MATERIAL, "\"DENSITY\": 3.0", "\"DENSITY\": 2.0, \"COMPUTE_LUMPED_MASS_MATRIX\": true");
    let changes: Vec<_> = scheme(NEWMARK).into_iter().chain([lumped]).collect();
    assert_order("newmark, lumped", &changes, free_end(), 2.0, 2.0);
}

#[test]
fn central_differences_are_of_second_order() {
    assert_order("central_differences", &EXPLICIT, (2.0_f64.sin(), None), 2.0, 2.0);
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
fn explicit_steps_follow_prescribed_motion_unless_told() {
    let mut changes = EXPLICIT.to_vec();
    let still = "\"constrained\": [true, true, true], \"value\": [0.0, 0.0, 0.0]";
    let moved = "\"constrained\": [true, true, true], \"value\": [\"0.25*t\", 0.0, 0.0]";
    changes.push((DECK, still, moved));
    let followed = oscillate(&changes, 0.05, 1.0);
    let end = followed.step(None).expect("a step");
    assert!((followed.nodal("DISPLACEMENT_X", end)[&1] - 0.25).abs() < 1e-12);
    // With the wall at t/4, w = u − t/4 swings from rest position with velocity 3/4.
    let exact = 0.25 + 0.75 * 1.0_f64.sin();
    assert!((last(&followed, "DISPLACEMENT_X") - exact).abs() < 1e-3, "{} {exact}", last(&followed, "DISPLACEMENT_X"));
    changes.push((DECK, "\"rayleigh_alpha\": 0.0", "\"follow_prescribed_motion\": false, \"rayleigh_alpha\": 0.0"));
    let held = oscillate(&changes, 0.05, 1.0);
    assert_eq!(held.nodal("DISPLACEMENT_X", 0)[&1], 0.0);
    assert!((last(&held, "DISPLACEMENT_X") - 1.0_f64.sin()).abs() < 1e-3);
}

/// A node that follows its neighbour with weight 1 hands on its mass and force: the motion is that of the free bar.
#[test]
fn explicit_steps_carry_what_follows_a_master() {
    let first = "Begin SubModelPart Body";
    let header = "Begin Constraints LinearMasterSlaveConstraint DISPLACEMENT_X DISPLACEMENT_X";
    let tied = format!("{header}\n1 0.0 [1.0] 3 2\nEnd Constraints\n\n{first}");
    let mut changes = EXPLICIT.to_vec();
    let free = oscillate(&changes, 0.05, 2.0);
    changes.push(("mesh.mdpa", first, &tied));
    let tied = oscillate(&changes, 0.05, 2.0);
    for node in [2, 3] {
        let [a, b] = [&free, &tied].map(|r| r.nodal("DISPLACEMENT_X", r.len() - 1)[&node]);
        assert!((a - b).abs() < 1e-14, "node {node}: {a} free, {b} tied");
    }
}

#[test]
fn schemes_and_contact_that_do_not_fit_are_refused() {
    let refused = |folder: &str, changes: &[(&str, &str, &str)], words: &[&str]| {
        let scratch = scratch_copy(&root().join("tests/decks").join(folder));
        for (file, find, with) in changes {
            change(scratch.path(), file, find, with);
        }
        let output = zelus(scratch.path(), &["run", DECK]);
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        words.iter().for_each(|word| assert!(said(&output).contains(word), "no {word:?} in {}", said(&output)));
    };
    let explicit = (DECK, "\"time_integration_method\": \"implicit\"", "\"time_integration_method\": \"explicit\"");
    let central = (DECK, "\"scheme_type\": \"newmark\"", "\"scheme_type\": \"central_differences\"");
    refused("oscillator", &[explicit], &["scheme-method", "newmark", "central_differences"]);
    refused("oscillator", &[central], &["scheme-method", "time_integration_method"]);
    refused("oscillator", &scheme("\"scheme_type\": \"bdf6\""), &["bdf6", "bdf"]);
    refused("oscillator", &scheme("\"scheme_type\": \"relaxation\""), &["relaxation", "pseudo_static"]);
    refused("oscillator", &scheme("\"scheme_type\": \"multi_stage\""), &["multi_stage", "central_differences"]);
    refused("oscillator", &scheme("\"scheme_type\": \"generalized_alpha\", \"rho_inf\": 1.5"), &["rho_inf", "1.5"]);
    refused("oscillator", &[explicit, central, (MATERIAL, "\"DENSITY\": 3.0", "\"DENSITY\": 0.0")], &["lumped-mass"]);
    let multipliers = [
        explicit,
        central,
        (DECK, "\"PenaltyContactFrictionless\"", "\"ALMContactFrictionless\""),
        (DECK, "\"penalty_contact_process\"", "\"alm_contact_process\""),
    ];
    refused("bouncing_block", &multipliers, &["contact-use", "multipliers have none", "penalty"]);
}

/// Kinetic and strain energy of the bouncing block, a bar of ten elements of width 0.1 with E = 100 and ρ = 1.
///
/// Explicit steps give the velocity of the step before and lump the mass.
fn block_energy(results: &Results, step: usize, explicit: bool) -> f64 {
    let u = results.nodal("DISPLACEMENT_Y", if explicit { step - 1 } else { step });
    let v = results.nodal("VELOCITY_Y", step);
    let nodes: Vec<u64> = u.keys().copied().collect();
    let rows: Vec<&[u64]> = nodes.chunks(2).collect();
    let mean = |field: &BTreeMap<u64, f64>, row: &[u64]| 0.5 * (field[&row[0]] + field[&row[1]]);
    let (width, height) = (0.1, 0.1);
    let mut energy = 0.0;
    for pair in rows.windows(2) {
        let [v0, v1] = [0, 1].map(|at| mean(&v, pair[at]));
        let square = if explicit { 0.5 * (v0 * v0 + v1 * v1) } else { (v0 * v0 + v0 * v1 + v1 * v1) / 3.0 };
        energy += 0.5 * width * height * square;
        energy += 0.5 * width * 100.0 / height * (mean(&u, pair[1]) - mean(&u, pair[0])).powi(2);
    }
    energy
}

/// Only the force of the penalty does work, and it is elastic: any change of energy is an error of time integration.
#[test]
fn a_block_bounces_with_an_energy_error_that_falls_with_the_step() {
    for explicit in [false, true] {
        let mut errors = Vec::new();
        for time_step in [0.001, 0.00025] {
            let scratch = scratch_copy(&root().join("tests/decks/bouncing_block"));
            change(scratch.path(), DECK, "\"time_step\": 0.001", &format!("\"time_step\": {time_step:e}"));
            if explicit {
                EXPLICIT[..2].iter().for_each(|(file, find, with)| change(scratch.path(), file, find, with));
            }
            let output = zelus(scratch.path(), &["run", DECK]);
            assert!(output.status.success(), "{}", said(&output));
            let results = Results::read(&scratch.path().join("results.json")).expect("results");
            let end = results.len() - 1;
            let energies: Vec<f64> = (1..=end).map(|step| block_energy(&results, step, explicit)).collect();
            let speed = results.nodal("VELOCITY_Y", end).values().sum::<f64>();
            assert!(speed > 0.0, "the block does not come back");
            let least = energies.iter().fold(f64::INFINITY, |least, e| least.min(*e));
            assert!(least < 0.98 * energies[0], "the block did not touch the plane: {least} of {}", energies[0]);
            assert!((energies[0] - 0.05).abs() < 1e-9, "{}", energies[0]);
            errors.push((energies[energies.len() - 1] / 0.05 - 1.0).abs());
            println!("explicit {explicit}, steps of {time_step}: energy off by {:.3e}", errors[errors.len() - 1]);
        }
        assert!(errors[0] < 2e-2 && errors[1] < 0.5 * errors[0], "{errors:?}");
    }
}
