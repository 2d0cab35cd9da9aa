//! One problem in ten sizes, all defaults: the same iterations, displacements and penetration relative to the size, in every
//! contact formulation, in the plane and in space. Penalties come from stiffness and mesh size, with no length of their own.

use crate::stacks::Stack;
use crate::support::{Results, read_json, said, zelus};
use serde_json::json;

const SIZES: [f64; 10] = [1.0, 1e-3, 6e-3, 0.02, 0.04, 0.3, 20.0, 30.0, 150.0, 1e3];

/// Difference allowed of penetrations and displacements, relative.
const TOLERANCE: f64 = 1e-6;

const BLOCKS: Stack = Stack {
    space: 2,
    divisions: [5, 7],
    tilt: 15.0,
    gap: 0.0,
    turn: 0.0,
    axis: [0.0, -1.0, 0.0],
    size: 1.0,
    guided: true,
    formulation: ("", ""),
    friction: 0.6,
    load: 1e-2,
};

/// Iterations of each step, deepest penetration and largest displacement over the size.
type SizeOutcome = (Vec<usize>, f64, f64);

fn outcome(stack: &Stack) -> Result<SizeOutcome, String> {
    let folder = tempfile::tempdir().expect("a scratch folder");
    stack.write(folder.path(), |deck| {
        let settings = &mut deck["solver_settings"];
        settings["residual_relative_tolerance"] = json!(1e-9);
        settings["residual_absolute_tolerance"] = json!(1e-300);
        settings["contact_settings"]["contact_residual_absolute_tolerance"] = json!(1e-300);
    });
    let output = zelus(folder.path(), &["run", "ProjectParameters.json", "--report", "report.json", "--threads", "1"]);
    if !output.status.success() {
        return Err(said(&output));
    }
    let report = read_json(&folder.path().join("report.json"))?;
    let steps = report["steps"].as_array().ok_or("no steps")?;
    let iterations = steps.iter().map(|step| step["iterations"].as_array().map_or(0, Vec::len)).collect();
    let numbers = steps.last().and_then(|step| step["interactions"].as_array()).ok_or("no numbers of contact")?;
    let depth = numbers.iter().find(|n| n[0] == "deepest penetration").and_then(|n| n[1].as_f64()).ok_or("no depth")?;
    let results = Results::read(&folder.path().join("results.json"))?;
    let axis = if stack.space == 2 { "DISPLACEMENT_Y" } else { "DISPLACEMENT_Z" };
    let motion = results.nodal(axis, results.len() - 1).values().fold(0.0_f64, |most, u| most.max(u.abs()));
    Ok((iterations, depth / stack.size, motion / stack.size))
}

/// Runs all sizes; penetrations must be below `deepest` times the size.
fn same_in_all_sizes(formulation: (&'static str, &'static str), deepest: f64) {
    let mut problems = Vec::new();
    for (space, divisions) in [(2, [5, 7]), (3, [2, 3])] {
        let stack = |size| Stack { space, divisions, size, formulation, ..BLOCKS };
        let (iterations, depth, motion) =
            outcome(&stack(SIZES[0])).unwrap_or_else(|said| panic!("{formulation:?}: {said}"));
        assert!(depth <= deepest, "{formulation:?}, {space} dimensions: {depth:.1e} deep");
        assert!(motion > 1e-3 && motion < 0.05, "{formulation:?}: {motion}");
        for &size in &SIZES[1..] {
            let place = format!("{formulation:?}, {space} dimensions, size {size}");
            match outcome(&stack(size)) {
                Err(said) => problems.push(format!("{place}: {said}")),
                Ok((found, ..)) if found != iterations => {
                    problems.push(format!("{place}: iterations {found:?}, not {iterations:?}"));
                }
                Ok((_, deep, far)) => {
                    // Closed gaps of multipliers are round-off.
                    if (deep - depth).abs() > TOLERANCE * depth + 1e-12 || (far - motion).abs() > TOLERANCE * motion {
                        problems.push(format!("{place}: {deep:e} deep, not {depth:e}; moved {far:e}, not {motion:e}"));
                    }
                }
            }
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn penalty() {
    same_in_all_sizes(("PenaltyContactFrictionless", "penalty_contact_process"), 1e-4);
    same_in_all_sizes(("PenaltyContactFrictional", "penalty_contact_process"), 1e-4);
}

#[test]
fn uzawa() {
    same_in_all_sizes(("UzawaContactFrictionless", "uzawa_contact_process"), 1e-6);
}

#[test]
fn augmented_lagrangian() {
    same_in_all_sizes(("ALMContactFrictionless", "alm_contact_process"), 1e-9);
    same_in_all_sizes(("ALMContactFrictional", "alm_contact_process"), 1e-9);
}

#[test]
fn perturbed_lagrangian() {
    same_in_all_sizes(("PerturbedLagrangianContactFrictionless", "perturbed_lagrangian_contact_process"), 1e-3);
}
