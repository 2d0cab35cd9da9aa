//! Several ranks in one process, each a thread with a simulation of its own: nothing of a run is global.

use crate::support;
use std::collections::BTreeMap;
use std::path::Path;

use crate::support::{root, scratch_copy};
use crate::thread_ranks::on_threads;
use serde_json::{Value, json};
use zelus::core::communication::Ranks;
use zelus::{RunOptions, Silent, Simulation};

/// Displacements by node, and the iterations of all steps.
type Outcome = (BTreeMap<usize, [f64; 3]>, Vec<usize>);

fn outcome(folder: &Path, ranks: Ranks) -> Outcome {
    let options = RunOptions { threads: Some(1), ranks, ..RunOptions::default() };
    let mut simulation = Simulation::open(&folder.join("ProjectParameters.json"), &options).expect("a deck");
    simulation.run(&mut Silent).expect("it converges");
    let displacement = simulation.field("DISPLACEMENT").expect("a field").chunks_exact(3);
    let ids = &simulation.part().expect("a part").nodes.ids;
    let by_node = ids.iter().zip(displacement).map(|(&id, u)| (id, [u[0], u[1], u[2]])).collect();
    (by_node, simulation.records().iter().map(|step| step.iterations.len()).collect())
}

fn is_near(found: &Outcome, expected: &Outcome) -> bool {
    let largest = expected.0.values().flatten().fold(0.0_f64, |most, u| most.max(u.abs()));
    let near =
        |(id, u): (&usize, &[f64; 3])| u.iter().zip(expected.0[id]).all(|(a, b)| (a - b).abs() <= 1e-9 * largest);
    found.1 == expected.1 && found.0.iter().all(near)
}

/// Runs on three ranks, on two and on one at the same time.
fn stand_side_by_side(case: &str) {
    stand_side_by_side_with(case, true, |_| {});
}

/// As [`stand_side_by_side`], with changed lists of processes; a small mesh may be whole on every rank.
fn stand_side_by_side_with(case: &str, is_shared: bool, change: fn(&mut Value)) {
    let changed = |case: &str| {
        let folder = scratch_copy(&root().join("tests/cases").join(case));
        let path = folder.path().join("ProjectParameters.json");
        let mut deck: Value =
            serde_json::from_str(&std::fs::read_to_string(&path).expect("a deck")).expect("a deck without comments");
        change(&mut deck["processes"]);
        std::fs::write(&path, deck.to_string()).expect("the changed deck");
        folder
    };
    let folder = changed(case);
    let expected = outcome(folder.path(), Ranks::default());
    let results = std::thread::scope(|scope| {
        let changed = &changed;
        let start = |count| {
            scope.spawn(move || {
                let own = changed(case);
                on_threads(count, |ranks| outcome(own.path(), ranks))
            })
        };
        let groups = [3, 2, 1].map(start);
        groups.map(|group| group.join().expect("a group of ranks"))
    });
    for of_ranks in results {
        let count = of_ranks.len();
        let nodes: usize = of_ranks.iter().map(|found| found.0.len()).sum();
        assert!(
            !is_shared || count == 1 || nodes < count * expected.0.len(),
            "{case} on {count} ranks: nothing is shared out"
        );
        assert!(of_ranks.iter().all(|found| is_near(found, &expected)), "{case} on {count} ranks: another answer");
    }
}

#[test]
fn contact_in_the_plane() {
    stand_side_by_side("contact_2d/opening");
    stand_side_by_side("contact_2d/friction_arc");
}

#[test]
fn contact_in_space() {
    stand_side_by_side("contact_3d/hexahedra_nonmatching");
}

fn along(part: &str, direction: Value) -> Value {
    json!({"python_module": "assign_displacement_along_direction_process", "Parameters": {
        "model_part_name": format!("Structure.{part}"), "direction": direction, "origin": [-30.0, 10.0, 0.0]}})
}

fn resultant(part: &str, force: Value, moment: [f64; 3], point: [f64; 3]) -> Value {
    json!([{"python_module": "distribute_resultant_on_part_process", "Parameters": {
        "model_part_name": format!("Structure.{part}"), "force": force, "moment": moment, "point": point}}])
}

/// Two directions at each node of the clamped edge of `structural/cooks_membrane_mixed`, and a remote load.
pub fn clamp_by_directions(lists: &mut Value) {
    lists["constraints_process_list"] = json!([along("Held", json!([0.6, 0.8, 0.0])), along("Held", json!("radial"))]);
    lists["loads_process_list"] = resultant("Pulled", json!([1.0, "5*t", 0.0]), [0.0, 0.0, 3.0], [60.0, 40.0, 0.0]);
}

/// A foundation of `contact_3d/hexahedra_nonmatching` that slides along a slope, sides by their normals, and a remote load.
pub fn slide_on_a_slope(lists: &mut Value) {
    lists["constraints_process_list"] = json!([
        along("Bottom", json!([0.6, 0.0, 0.8])),
        along("SidesX", json!("surface_normal")),
        along("SidesY", json!([0.0, 1.0, 0.0])),
    ]);
    lists["loads_process_list"] = resultant("Top", json!([0.0, 0.0, "-1e6*t"]), [2e4, 0.0, 0.0], [0.5, 0.55, 2.0]);
}

#[test]
fn directions_and_resultants() {
    stand_side_by_side_with("structural/cooks_membrane_mixed", true, clamp_by_directions);
    stand_side_by_side_with("contact_3d/hexahedra_nonmatching", false, slide_on_a_slope);
}

/// A mesh that a process cuts before ranks share it.
#[test]
fn a_bolt() {
    stand_side_by_side("constraints/tightened_bolt");
}

/// A rigid body with its own centre of mass swings at the left face of `constraints/coupled_block`, whose right face is held.
pub fn hang_a_body(lists: &mut Value) {
    let constraints = &mut lists["constraints_process_list"];
    let body = &mut constraints[0]["Parameters"];
    (body["mass"], body["inertia"]) = (json!(3.0), json!([0.2, 0.3, 0.4]));
    body["centre_of_mass"] = json!([-1.5, 0.3, 0.8]);
    let vector = |part: &str, variable: &str, held: bool, value: [f64; 3]| {
        json!({"python_module": "assign_vector_variable_process", "Parameters": {"model_part_name": part,
            "variable_name": variable, "constrained": [held, held, held], "value": value}})
    };
    constraints[2] = vector("Structure.Right", "DISPLACEMENT", true, [0.0; 3]);
    constraints[3] = vector("Structure", "VOLUME_ACCELERATION", false, [0.0, 0.0, -0.4]);
}

/// Force and moment on the distributing coupling of `constraints/coupled_block`.
pub fn bend_by_the_mean(lists: &mut Value) {
    let load = |variable: &str, value: [&str; 3]| {
        json!({"python_module": "assign_vector_variable_to_conditions_process", "Parameters": {
            "model_part_name": "Structure.Sensor", "variable_name": variable, "value": value}})
    };
    let constraints = lists["constraints_process_list"].as_array_mut().expect("a list");
    constraints.push(load("POINT_MOMENT", ["0.2*t", "0.1*t", "0.3*t"]));
    constraints.push(load("POINT_LOAD", ["0.1*t", "-0.2*t", "0.1*t"]));
}

/// Reference nodes and masses that are made before ranks share the mesh.
#[test]
fn couplings() {
    // The mesh is small: every rank has all of it.
    stand_side_by_side_with("constraints/coupled_block", false, |_| {});
    stand_side_by_side_with("constraints/coupled_block", false, hang_a_body);
    stand_side_by_side_with("constraints/coupled_block", false, bend_by_the_mean);
}

/// Ranks that have nothing of a variable measure it with the others.
#[test]
fn unknowns_of_several_kinds() {
    stand_side_by_side("mesh_tying/tetrahedra_on_hexahedra");
    stand_side_by_side("structural/volumetric_strain_swings_3D8N");
}

#[test]
fn errors_are_those_of_one_process() {
    let folder = scratch_copy(&root().join("tests/cases/contact_2d/opening"));
    support::change(
        folder.path(),
        "ProjectParameters.json",
        "\"model_part_name\": \"Structure.",
        "\"model_part_name\": \"Structure.No",
    );
    let run = |ranks: Ranks| {
        let options = RunOptions { threads: Some(1), ranks, ..RunOptions::default() };
        let mut simulation = Simulation::open(&folder.path().join("ProjectParameters.json"), &options).expect("a deck");
        simulation.run(&mut Silent).expect_err("a part that is not there").to_string()
    };
    let alone = run(Ranks::default());
    assert!(on_threads(3, run).iter().all(|said| *said == alone));
}
