//! Linear solvers over ranks.

use std::path::Path;
use std::process::Output;

use crate::runs::*;
use crate::support::{change, read_json, root, said, scratch_copy, zelus};

/// κ of the system of all ranks, not of the share of one.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn condition_numbers_are_those_of_the_whole_system() {
    let folder = case("contact_2d/nonmatching");
    let asks = "\"mortar_type\": \"ALMContactFrictionless\"";
    change(folder.path(), DECK, asks, &format!("{asks}, \"condn_convergence_criterion\": true"));
    let arguments = ["run", DECK, "--report", "report.json"];
    let number = |folder: &Path| -> f64 {
        let report = read_json(&folder.join("report.json")).expect("the report");
        report["steps"][0]["iterations"][0]["condition_number"].as_f64().expect("a condition number")
    };
    assert!(zelus(folder.path(), &arguments).status.success());
    let alone = number(folder.path());
    for ranks in [2, 3] {
        let output = distributed(folder.path(), ranks, &arguments);
        assert!(output.status.success(), "{}", said(&output));
        let shared = number(folder.path());
        assert!((shared - alone).abs() <= EQUAL * alone, "{ranks} ranks: {shared}, not {alone}");
    }
}

#[test]
#[cfg_attr(not(feature = "petsc"), ignore = "needs the feature `petsc`")]
fn petsc_solves_for_all() {
    let asks = "\"solver_type\": \"Static\", \"linear_solver_settings\": {\"petsc_engine\": \"automatic\"}";
    let asks = [("\"solver_type\": \"Static\"", asks)];
    equals_serial("contact_2d/nonmatching", &asks, EXACT, true);
    equals_serial("contact_2d/opening", &asks, EXACT, true);
    equals_serial("contact_3d/hexahedra_nonmatching", &asks, EXACT, true);
    equals_serial("mesh_tying/tetrahedra_on_hexahedra", &asks, EXACT, true);
    equals_serial("mpc/pressed_and_opened", &asks, EXACT, true);
    let slips = ("\"WEIGHTED_SLIP\"", "\"DISPLACEMENT\"");
    equals_serial("contact_3d/friction_stick", &[asks[0], slips], EXACT, true);
}

/// Multigrid gets systems without multipliers; where these cannot be condensed a factorisation serves, and a warning
/// says so.
#[test]
#[cfg_attr(not(feature = "petsc"), ignore = "needs the feature `petsc`")]
fn multigrid_solves_for_all_but_multipliers() {
    let gmres = "\"solver_type\": \"gmres\", \"petsc_engine\": \"gmres_gamg\"";
    equals_serial("contact_3d/iterative_engine", &[("\"solver_type\": \"gmres\"", gmres)], EQUAL, false);
    let asks = "\"solver_type\": \"Static\", \"linear_solver_settings\": {\"petsc_engine\": \"gmres_gamg\", \"tolerance\": 1e-11}";
    equals_serial("mesh_tying/tetrahedra_on_hexahedra", &[("\"solver_type\": \"Static\"", asks)], EQUAL, false);
    for (name, is_condensed) in [("mesh_tying/hexahedra", true), ("mesh_tying/hexahedra_on_tetrahedra", false)] {
        let folder = case(name);
        change(folder.path(), DECK, "\"solver_type\": \"Static\"", asks);
        let arguments = ["run", DECK, "--report", "report.json"];
        let output = distributed(folder.path(), 2, &arguments);
        assert!(output.status.success(), "{name}: {}", said(&output));
        let report = read_json(&folder.path().join("report.json")).expect("the report");
        let engine = &report["steps"][0]["iterations"][0]["engine"];
        assert_eq!(engine, if is_condensed { "gmres_gamg" } else { "mumps_lu" }, "{name}: {}", said(&output));
        assert_eq!(
            said(&output).matches("warning[not-condensed]").count(),
            usize::from(!is_condensed),
            "{}",
            said(&output)
        );
    }
}

const MULTIGRID: (&str, &str) = (
    "\"Static\"",
    "\"Static\", \"linear_solver_settings\": {\"solver_type\": \"amgcl\", \"direct_below\": 0, \"tolerance\": 1e-11}",
);

/// Results of multigrid where the rows are equal those of one process.
fn multigrid_equals_serial(case: &str, changes: &[(&str, &str)]) {
    let changes = [&[MULTIGRID], changes].concat();
    // Criteria of sliding are met by a hair.
    equals_serial(case, &changes, EQUAL, !case.contains("friction"));
    let folder = self::case(case);
    changes.iter().for_each(|(find, with)| change(folder.path(), DECK, find, with));
    let output = distributed(folder.path(), 3, &["run", DECK, "--report", "report.json"]);
    assert!(output.status.success(), "{case}: {}", said(&output));
    let report = read_json(&folder.path().join("report.json")).expect("the report");
    let iterations = report["steps"].as_array().expect("steps").iter().flat_map(|step| step["iterations"].as_array());
    for iteration in iterations.flatten() {
        assert_eq!(iteration["engine"], "multigrid over ranks", "{case}: {iteration}");
        assert!(iteration["fallback"].is_null(), "{case}: {iteration}");
    }
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn multigrid_over_ranks() {
    multigrid_equals_serial("contact_2d/nonmatching", &[]);
    multigrid_equals_serial("contact_3d/hexahedra_nonmatching", &[]);
    multigrid_equals_serial("contact_3d/hexahedra_on_tetrahedra", &[]);
    multigrid_equals_serial("contact_3d/nitsche", &[]);
    let pressure = ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", "VECTOR_LAGRANGE_MULTIPLIER");
    let components = ("\"ALMContactFrictionless\"", "\"ALMContactFrictionlessComponents\"");
    let of_components = ("\"contact_type\": \"Frictionless\"", "\"contact_type\": \"FrictionlessComponents\"");
    multigrid_equals_serial("contact_3d/hexahedra_nonmatching", &[components, of_components, pressure]);
    let gap = ("\"LAGRANGE_MULTIPLIER_CONTACT_PRESSURE\", \"WEIGHTED_GAP\"", "\"DISPLACEMENT\"");
    let penalty = [("alm_contact_process", "penalty_contact_process"), ("ALMContact", "PenaltyContact"), gap];
    multigrid_equals_serial("contact_3d/hexahedra_nonmatching", &penalty);
    multigrid_equals_serial("mpc/pressed_and_opened_hexahedra", &[]);
    multigrid_equals_serial("mpc/tying_matching_hexahedra", &[]);
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn multigrid_over_ranks_with_friction_and_ties() {
    multigrid_equals_serial("contact_2d/friction_slide", &[]);
    multigrid_equals_serial("contact_3d/friction_slide", &[]);
    let slips = ("\"FRICTION_TRACTION\", \"WEIGHTED_SLIP\"", "\"DISPLACEMENT\"");
    // With a stiff penalty the remaining errors of displacements cause larger ones of the pressure.
    let pressures = ("\"AUGMENTED_NORMAL_CONTACT_PRESSURE\"", "\"DISPLACEMENT\"");
    multigrid_equals_serial("contact_3d/friction_penalty_slide", &[slips, pressures]);
    multigrid_equals_serial("contact_3d/friction_stick", &[("\"WEIGHTED_SLIP\"", "\"DISPLACEMENT\"")]);
    multigrid_equals_serial("mesh_tying/hexahedra", &[]);
    multigrid_equals_serial("mesh_tying/tetrahedra_on_hexahedra", &[]);
}

/// More equations than the coarsest level takes: without the motions of bodies the iteration is a longer one.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn levels_over_ranks_are_as_good_as_those_of_one() {
    let folder = scratch_copy(&root().join("examples/hertz_sphere"));
    change(folder.path(), DECK, MULTIGRID.0, MULTIGRID.1);
    change(folder.path(), DECK, "\"end_time\": 1.0", "\"end_time\": 0.25");
    let arguments = ["run", DECK, "--report", "report.json"];
    let solves = |output: Output, engine: &str| -> Vec<f64> {
        assert!(output.status.success(), "{}", said(&output));
        let report = read_json(&folder.path().join("report.json")).expect("the report");
        let iterations = report["steps"][0]["iterations"].as_array().expect("iterations");
        assert!(iterations.iter().all(|iteration| iteration["engine"] == engine), "{}", said(&output));
        iterations.iter().map(|iteration| iteration["linear_iterations"].as_f64().expect("a number")).collect()
    };
    let alone = solves(zelus(folder.path(), &arguments), "multigrid");
    for ranks in [2, 3] {
        let shared = solves(distributed(folder.path(), ranks, &arguments), "multigrid over ranks");
        let alike = shared.len() == alone.len() && shared.iter().zip(&alone).all(|(a, b)| *a <= 1.15 * b + 2.0);
        assert!(alike, "{ranks} ranks: {shared:?} iterations, not {alone:?}");
    }
}
