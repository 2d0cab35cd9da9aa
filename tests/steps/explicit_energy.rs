//! Energies and mass scaling of explicit steps against closed forms: ANALYTIC, but where a test says otherwise.
//!
//! The oscillator is that of [`super::time_integration`]: m = k = 1, u = sin t. Energies of a step are those at its start.

use std::fmt::Write as _;
use std::path::Path;

use crate::support::{change, read_json, root, said, scratch_copy, zelus};
use serde_json::{Value, json};

const DECK: &str = "ProjectParameters.json";
const MATERIAL: &str = "StructuralMaterials.json";
const EXPLICIT: [(&str, &str, &str); 2] = [
    (DECK, "\"time_integration_method\": \"implicit\"", "\"time_integration_method\": \"explicit\""),
    (DECK, "\"scheme_type\": \"newmark\"", "\"scheme_type\": \"central_differences\""),
];

fn write_json(path: &Path, value: &Value) {
    std::fs::write(path, value.to_string()).expect("a file");
}

/// Runs the deck of a folder; its report.
fn report(folder: &Path) -> Value {
    let output = zelus(folder, &["run", DECK, "--report", "run.json"]);
    assert!(output.status.success(), "{}", said(&output));
    read_json(&folder.join("run.json")).expect("a report")
}

/// The energies of a step by name.
fn energy(step: &Value, name: &str) -> f64 {
    step["balance"]["energies"][name].as_f64().unwrap_or_else(|| panic!("no {name} in {step}"))
}

fn steps(report: &Value) -> &[Value] {
    report["steps"].as_array().expect("steps")
}

/// The oscillator in explicit steps, after changes of its files.
fn oscillate(time_step: f64, end_time: f64, changes: &[(&str, &str, &str)]) -> Value {
    let scratch = scratch_copy(&root().join("tests/decks/oscillator"));
    EXPLICIT.iter().chain(changes).for_each(|(file, find, with)| change(scratch.path(), file, find, with));
    change(scratch.path(), MATERIAL, "\"DENSITY\": 3.0", "\"DENSITY\": 2.0");
    change(scratch.path(), DECK, "\"time_step\": 0.1", &format!("\"time_step\": {time_step:e}"));
    change(scratch.path(), DECK, "\"end_time\": 1.0", &format!("\"end_time\": {end_time:e}"));
    report(scratch.path())
}

/// No warning of the step, the energies or the masses.
fn assert_quiet(report: &Value) {
    let warnings = report["warnings"].to_string();
    assert!(!["explicit-", "mass-scaling", "-step"].iter().any(|code| warnings.contains(code)), "{warnings}");
}

/// Checks at the start of each step what `of` says of its time; remainders are round-off.
fn check(report: &Value, of: impl Fn(f64, &Value)) {
    for step in steps(report) {
        let time = step["time"].as_f64().unwrap() - step["delta_time"].as_f64().unwrap();
        assert!(energy(step, "remainder").abs() < 1e-12, "{step}");
        of(time, step);
    }
    assert_quiet(report);
}

fn assert_near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance, "{what}: {found:e}, not {expected:e}");
}

/// ½ cos² t and ½ sin² t; the errors of central differences are of the second order, (ω Δt)²/8 of the energy and less.
#[test]
fn a_free_bar_swaps_strain_and_kinetic_energy() {
    check(&oscillate(0.02, 10.0, &[]), |t, step| {
        assert_near(energy(step, "stored"), 0.5 * t.sin().powi(2), 3e-4, "strain energy");
        assert_near(energy(step, "kinetic"), 0.5 * t.cos().powi(2), 3e-4, "kinetic energy");
        assert_near(energy(step, "unresolved"), 1e-4 * energy(step, "stored"), 1e-9, "unresolved");
        assert_eq!([energy(step, "loads"), energy(step, "damping"), energy(step, "penalty")], [0.0; 3]);
    });
}

/// Damping c = α m with α = 0.1: the energy falls as that of a damped oscillator, E' = −α v². Damping forces lag by a step, an error of the
/// first order: α Δt/2 of the energy.
#[test]
fn damping_takes_the_energy_that_motion_loses() {
    let alpha = 0.1;
    let report = oscillate(0.01, 10.0, &[(DECK, "\"rayleigh_alpha\": 0.0", "\"rayleigh_alpha\": 0.1")]);
    let damped = (1.0 - alpha * alpha / 4.0_f64).sqrt();
    check(&report, |t, step| {
        let decay = (-0.5 * alpha * t).exp();
        let u = decay * (damped * t).sin() / damped;
        let v = decay * ((damped * t).cos() - 0.5 * alpha * (damped * t).sin() / damped);
        assert_near(energy(step, "damping"), 0.5 * (1.0 - u * u - v * v), 1e-3, "damping");
    });
    assert!(energy(steps(&report).last().unwrap(), "damping") > 0.25);
}

/// The wall moves with 1/4 from t = 0 on: it takes along the mass 1 of its own nodes, with 1/32, and does the work of k (w − u) then, with
/// w − u = −¾ sin t. Tolerance: the error of the second order.
#[test]
fn moving_supports_do_work() {
    let still = "\"constrained\": [true, true, true], \"value\": [0.0, 0.0, 0.0]";
    let moved = "\"constrained\": [true, true, true], \"value\": [\"0.25*t\", 0.0, 0.0]";
    check(&oscillate(0.01, 6.0, &[(DECK, still, moved)]), |t, step| {
        let expected = if t > 0.0 { 1.0 / 32.0 - 0.1875 * (1.0 - t.cos()) } else { 0.0 };
        assert_near(energy(step, "supports"), expected, 2e-4, "work of the support");
    });
}

/// A constant force of 0.4 and a weight of 0.3 do the work 0.7 u, with u = sin t + 0.7 (1 − cos t). Tolerance: the error of the second
/// order.
#[test]
fn loads_and_weight_do_work() {
    let weight = r#""loads_process_list": [
      {"python_module": "assign_vector_by_direction_process", "kratos_module": "KratosMultiphysics", "Parameters": {
        "model_part_name": "Structure", "variable_name": "VOLUME_ACCELERATION", "constrained": false, "modulus": 0.3,
        "direction": [1.0, 0.0, 0.0], "interval": [0.0, "End"]}},"#;
    let changes = [(DECK, "\"0.0*t\"", "0.2"), (DECK, "\"loads_process_list\": [", weight)];
    check(&oscillate(0.01, 6.0, &changes), |t, step| {
        assert_near(energy(step, "loads"), 0.7 * (t.sin() + 0.7 * (1.0 - t.cos())), 2e-4, "work of loads");
    });
}

/// A step of 1.05 of the critical one is warned of, and named with the node before numbers overflow.
#[test]
fn an_unstable_step_is_named() {
    let report = oscillate(2.1, 10.5, &[]);
    let warnings = report["warnings"].to_string();
    for words in ["explicit-unstable", "energy supplied", "of node", "time_step"] {
        assert!(warnings.contains(words), "no {words:?} in {warnings}");
    }
    let stable = oscillate(1.9, 30.0, &[]);
    assert!(!stable["warnings"].to_string().contains("explicit-"), "{}", stable["warnings"]);
}

/// A bar that bounces keeps its energy of 0.05, in implicit steps and in explicit ones; at the turn a part of it is in the springs of the penalty.
/// Tolerance: 4e-4 of the energy in implicit steps, an error of the second order; 4e-3 in explicit ones, whose trapezoid at the instant of
/// contact is off by half the pressure times the gap that closes.
#[test]
fn a_bar_bounces_with_its_energy() {
    for explicit in [false, true] {
        let scratch = scratch_copy(&root().join("tests/decks/bouncing_block"));
        if explicit {
            EXPLICIT.iter().for_each(|(file, find, with)| change(scratch.path(), file, find, with));
        }
        let report = report(scratch.path());
        let sum = |step: &Value| ["kinetic", "stored", "penalty"].iter().map(|name| energy(step, name)).sum::<f64>();
        let [mut most, mut worst] = [0.0_f64; 2];
        for step in steps(&report) {
            let unresolved = if explicit { energy(step, "unresolved") } else { 0.0 };
            worst = worst.max((sum(step) - unresolved - 0.05).abs());
            most = most.max(energy(step, "penalty"));
        }
        println!("explicit {explicit}: off by {worst:.2e}, up to {most:.2e} in the penalty");
        assert!(worst < if explicit { 2e-4 } else { 2e-5 }, "explicit {explicit}: {worst}");
        assert!(most > 1e-4, "explicit {explicit}: {most}");
        let last = steps(&report).last().unwrap();
        assert_eq!(energy(last, "penalty"), 0.0);
        assert_quiet(&report);
    }
}

/// Length of the small cell of the graded bar, and its centre.
const SMALL: f64 = 0.004;
const PLACE: f64 = 0.798;

/// Cells of 0.02, one of which has a small one cut off, in a bar of length 1 whose first end is held, E = ρ = 1, run until `end`; the report, and times and
/// displacements of the other end.
fn graded_bar(solver: &Value, end: f64) -> (Value, Vec<(f64, f64)>) {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let cells = (0..=50).map(|i| 0.02 * f64::from(i));
    let xs: Vec<f64> = cells.flat_map(|x| if (x - 0.8).abs() < 1e-9 { vec![x - SMALL, x] } else { vec![x] }).collect();
    let mut mesh = String::from("Begin Properties 0\nEnd Properties\n\nBegin Nodes\n");
    for (at, x) in xs.iter().enumerate() {
        writeln!(mesh, "{} {x:e} 0 0\n{} {x:e} 1 0", 2 * at + 1, 2 * at + 2).unwrap();
    }
    mesh += "End Nodes\n\nBegin Elements SmallDisplacementElement2D4N\n";
    for at in 0..xs.len() - 1 {
        writeln!(mesh, "{} 0 {} {} {} {}", at + 1, 2 * at + 1, 2 * at + 3, 2 * at + 4, 2 * at + 2).unwrap();
    }
    mesh += "End Elements\n\nBegin NodalData VELOCITY_X\n";
    for (at, x) in xs.iter().enumerate() {
        let speed = 0.01 * (0.5 * std::f64::consts::PI * x).sin();
        writeln!(mesh, "{} 0 {speed:e}\n{} 0 {speed:e}", 2 * at + 1, 2 * at + 2).unwrap();
    }
    mesh += "End NodalData\n";
    let nodes: Vec<usize> = (1..=2 * xs.len()).collect();
    let mut part = |name: &str, nodes: &[usize], elements: usize| {
        let list = |ids: &mut dyn Iterator<Item = usize>| ids.map(|id| format!("{id}\n")).collect::<String>();
        let (nodes, elements) = (list(&mut nodes.iter().copied()), list(&mut (1..=elements)));
        write!(
            mesh,
            "\nBegin SubModelPart {name}\nBegin SubModelPartNodes\n{nodes}End SubModelPartNodes\nBegin SubModelPartElements\n\
             {elements}End SubModelPartElements\nEnd SubModelPart\n"
        )
        .unwrap();
    };
    part("Bar", &nodes, xs.len() - 1);
    part("Held", &[1, 2], 0);
    part("Moving", &nodes[2..], 0);
    part("Tip", &[2 * xs.len()], 0);
    std::fs::write(folder.path().join("mesh.mdpa"), mesh).expect("the mesh");
    let material = json!({"properties": [{"model_part_name": "Structure.Bar", "properties_id": 1, "Material": {
        "constitutive_law": {"name": "LinearElasticPlaneStress2DLaw"},
        "Variables": {"YOUNG_MODULUS": 1.0, "POISSON_RATIO": 0.0, "DENSITY": 1.0}, "Tables": {}}}]});
    write_json(&folder.path().join(MATERIAL), &material);
    let fixed = |part: &str, along: bool| {
        json!({"python_module": "assign_vector_variable_process", "kratos_module": "KratosMultiphysics", "Parameters": {
            "model_part_name": format!("Structure.{part}"), "variable_name": "DISPLACEMENT", "constrained": [along, true, true],
            "value": [if along { json!(0.0) } else { Value::Null }, 0.0, 0.0], "interval": [0.0, "End"]}})
    };
    let mut deck = json!({
        "problem_data": {"problem_name": "bar", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0, "end_time": end},
        "solver_settings": {"solver_type": "Dynamic", "model_part_name": "Structure", "domain_size": 2, "echo_level": 0,
            "time_integration_method": "explicit", "scheme_type": "central_differences",
            "model_import_settings": {"input_type": "mdpa", "input_filename": "mesh"},
            "material_import_settings": {"materials_filename": MATERIAL},
            "time_stepping": {"time_step": 0.01}},
        "processes": {"constraints_process_list": [fixed("Held", true), fixed("Moving", false)],
            "json_output_process_list": [{"python_module": "json_output_process", "kratos_module": "KratosMultiphysics",
                "Parameters": {"output_file_name": "tip.json", "model_part_name": "Structure.Tip",
                    "output_variables": ["DISPLACEMENT"], "time_frequency": 0.0}}]}});
    let settings = deck["solver_settings"].as_object_mut().unwrap();
    settings.extend(solver.as_object().unwrap().clone());
    write_json(&folder.path().join(DECK), &deck);
    let report = report(folder.path());
    let results = crate::support::Results::read(&folder.path().join("tip.json")).expect("results");
    let of = |(step, time): (usize, &f64)| (*time, results.nodal("DISPLACEMENT_X", step)[&(2 * xs.len() as u64)]);
    let motion = results.times().iter().enumerate().map(of).collect();
    (report, motion)
}

/// Frequency of the first mode, from the time in which the end of the bar swings back and forth so often.
fn frequency(motion: &[(f64, f64)]) -> f64 {
    let crosses = motion.windows(2).filter(|pair| (pair[0].1 > 0.0) != (pair[1].1 > 0.0) && pair[0].0 > 0.5);
    let times: Vec<f64> =
        crosses.map(|pair| pair[0].0 + (pair[1].0 - pair[0].0) * pair[0].1 / (pair[0].1 - pair[1].1)).collect();
    std::f64::consts::PI * times.len() as f64 / times.last().expect("it swings back")
}

/// First frequency k of the bar with the mass m at x: cot(k x) − tan(k (1 − x)) = m k, by bisection.
fn frequency_with_mass(m: f64, x: f64) -> f64 {
    let [mut low, mut high] = [1.0, 0.5 * std::f64::consts::PI];
    for _ in 0..60 {
        let k: f64 = 0.5 * (low + high);
        let left = 1.0 / (k * x).tan() - (k * (1.0 - x)).tan() - m * k;
        if left > 0.0 { low = k } else { high = k }
    }
    low
}

/// A cell of length a has ω² = 4 E/(ρ a²), and gets the mass (ω²/ω_s² − 1) ρ a, where ω_s² = (2/(Δt/0.8))²/1.02 with the margin of the
/// estimate. The first frequency falls as that of a bar with a mass on it, by 2.5 %: tolerance 5e-4, other modes in the motion of the end.
#[test]
fn scaled_mass_gives_the_step_and_its_share() {
    let step = 0.009_f64;
    let share = (4.0 / (SMALL * SMALL) / ((1.6 / step).powi(2) / 1.02) - 1.0) * SMALL;
    let scaled = json!({"time_step_prediction_level": 1, "mass_scaling_time_step": step});
    let (report, motion) = graded_bar(&scaled, 22.0);
    let found = report["parameters"]["added mass by mass"].as_f64().expect("the share");
    assert!((found / share - 1.0).abs() < 1e-9, "{found}, not {share}");
    let most = steps(&report).iter().map(|own| own["delta_time"].as_f64().unwrap()).fold(0.0, f64::max);
    assert!((most / step - 1.0).abs() < 1e-9, "{most}");
    assert!(report["notes"].to_string().contains("1 element of a critical step below"), "{}", report["notes"]);
    check(&report, |_, _| {});
    let (plain, free) = graded_bar(&json!({"time_step_prediction_level": 1}), 22.0);
    let short = steps(&plain)[0]["delta_time"].as_f64().unwrap();
    assert!(short < 0.9 * step, "{short} without mass scaling");
    let (slower, expected) =
        (frequency(&motion) / frequency(&free), frequency_with_mass(share, PLACE) / (0.5 * std::f64::consts::PI));
    println!("first frequency {slower:.5}, expected {expected:.5}");
    assert!((slower - expected).abs() < 5e-4 && expected < 0.98, "{slower}, not {expected}");
}

/// A step that the bar reaches by itself adds nothing; one that adds more than 5 % of mass is warned of.
#[test]
fn only_needed_mass_is_added_and_much_is_warned_of() {
    let share = |step: f64| {
        let (report, _) = graded_bar(&json!({"time_step_prediction_level": 1, "mass_scaling_time_step": step}), 0.5);
        (report["parameters"]["added mass by mass"].as_f64().expect("the share"), report["warnings"].to_string())
    };
    assert_eq!(share(0.006).0, 0.0);
    let (much, warnings) = share(0.0155);
    assert!(warnings.contains("mass-scaling") && warnings.contains("% of the mass"), "{warnings}");
    assert!(much > 0.05, "{much}");
}
