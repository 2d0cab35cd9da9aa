//! Penalties with all defaults beside multipliers: the same pressures and tractions on curved unlike meshes, and both balance the
//! loads. Bodies touch at a node first.

use crate::support::{Results, read_json, root, said, scratch_copy, zelus};
use serde_json::{Value, json};
use std::path::Path;

const DECK: &str = "ProjectParameters.json";

/// Difference allowed between a penalty and its twin, and of both from the load, relative to the largest number.
const TOLERANCE: f64 = 1e-3;

/// Nodal numbers of the slave side at some times.
struct PenaltyRun {
    history: Results,
    values: Results,
}

impl PenaltyRun {
    /// A case with another formulation, all defaults of its process but for settings of the problem itself.
    fn of(case: &str, process: &str, formulation: &str) -> Self {
        let scratch = scratch_copy(&root().join("tests/cases").join(case));
        let file = scratch.path().join(DECK);
        let mut deck = read_json(&file).expect("the deck");
        deck["solver_settings"]["contact_settings"]["mortar_type"] = json!(formulation);
        let list = &mut deck["processes"]["contact_process_list"][0];
        list["python_module"] = json!(process);
        list["Parameters"].as_object_mut().expect("settings").remove("advance_ALM_parameters");
        let output = |name: &str, module: &str, flag: bool, variables: &[&str]| {
            json!({"python_module": module, "kratos_module": "KratosMultiphysics", "Parameters": {
                "output_file_name": name, "model_part_name": "Structure.Slave", "output_variables": variables,
                "historical_value": flag, "time_frequency": 0.0}})
        };
        let mut tractions = vec!["AUGMENTED_NORMAL_CONTACT_PRESSURE", "NODAL_AREA"];
        if formulation.ends_with("Frictional") {
            tractions.push("AUGMENTED_TANGENT_CONTACT_PRESSURE");
        }
        deck["processes"]["json_output_process_list"] = json!([
            output("history.json", "json_output_process", true, &["DISPLACEMENT"]),
            output("values.json", "json_output_process", false, &tractions),
        ]);
        std::fs::write(&file, serde_json::to_string_pretty::<Value>(&deck).expect("JSON")).expect("a file");
        let ran = zelus(scratch.path(), &["run", DECK, "--threads", "2"]);
        assert!(ran.status.success(), "{formulation}: {}", said(&ran));
        let read = |name: &str| Results::read(Path::new(&scratch.path().join(name))).expect("results");
        Self { history: read("history.json"), values: read("values.json") }
    }

    fn step(&self, time: f64) -> usize {
        self.values.step(Some(time)).expect("a step")
    }

    /// Sum of a traction over the areas of the nodes.
    fn total(&self, traction: &str, time: f64) -> f64 {
        let step = self.step(time);
        let areas = self.values.nodal("NODAL_AREA", step);
        self.values.nodal(traction, step).iter().map(|(node, t)| t * areas[node]).sum()
    }

    /// Largest difference of a quantity from a twin's over the largest number.
    fn differs(&self, twin: &Self, quantity: &str, time: f64) -> f64 {
        let of = |run: &Self| {
            let results = if quantity.starts_with("DISPLACEMENT") { &run.history } else { &run.values };
            results.nodal(quantity, run.step(time))
        };
        let (own, other) = (of(self), of(twin));
        let largest = other.values().fold(0.0_f64, |most, v| most.max(v.abs()));
        own.iter().map(|(node, v)| (v - other[node]).abs() / largest).fold(0.0, f64::max)
    }
}

/// Sheared cylinders (Cattaneo and Mindlin) at three loads: stick in the middle, slip at the edges.
#[test]
fn sheared_cylinders() {
    let case = "contact_2d/cattaneo_mindlin_light_coarse";
    let twin = PenaltyRun::of(case, "alm_contact_process", "ALMContactFrictional");
    let penalty = PenaltyRun::of(case, "penalty_contact_process", "PenaltyContactFrictional");
    let (force, shear) = (0.1, 2.0 * 8.0 * 0.05851e-2);
    for time in [1.25, 1.625, 2.0] {
        for run in [&twin, &penalty] {
            let pressed = run.total("AUGMENTED_NORMAL_CONTACT_PRESSURE", time) / -force;
            let sheared = run.total("AUGMENTED_TANGENT_CONTACT_PRESSURE_X", time).abs() / (shear * (time - 1.0));
            println!("t = {time}: pressed by {pressed:.6}, sheared by {sheared:.6} of the loads");
            // Pressures that differ left and right bear a little of the shear along the curved surface.
            assert!(
                (pressed - 1.0).abs() < TOLERANCE && (sheared - 1.0).abs() < 3.0 * TOLERANCE,
                "{pressed}, {sheared}"
            );
        }
        let [sheared, expected] = [&penalty, &twin].map(|run| run.total("AUGMENTED_TANGENT_CONTACT_PRESSURE_X", time));
        assert!((sheared / expected - 1.0).abs() < TOLERANCE, "{sheared}, by multipliers {expected}");
        // At the edge of stick bodies slip by as little as the elongation of the spring.
        for (quantity, tolerance) in [
            ("AUGMENTED_NORMAL_CONTACT_PRESSURE", TOLERANCE),
            ("AUGMENTED_TANGENT_CONTACT_PRESSURE_X", 10.0 * TOLERANCE),
            ("DISPLACEMENT_Y", TOLERANCE),
        ] {
            let off = penalty.differs(&twin, quantity, time);
            println!("t = {time}: {quantity} off by {off:.1e}");
            assert!(off < tolerance, "{quantity} differs by {off}");
        }
    }
}

/// Spheres in their meridional plane, which touch at a point first.
#[test]
fn pressed_spheres() {
    let case = "contact_2d/hertz_spheres_light_coarse";
    let twin = PenaltyRun::of(case, "alm_contact_process", "ALMContactFrictionless");
    for (process, formulation) in [
        ("penalty_contact_process", "PenaltyContactFrictionless"),
        ("perturbed_lagrangian_contact_process", "PerturbedLagrangianContactFrictionless"),
    ] {
        let run = PenaltyRun::of(case, process, formulation);
        for time in [0.3, 1.0] {
            let pressed = run.total("AUGMENTED_NORMAL_CONTACT_PRESSURE", time) / (-117.808787 * time.powi(3));
            println!("{formulation}, t = {time}: pressed by {pressed:.6} of the load");
            assert!((pressed - 1.0).abs() < TOLERANCE, "{formulation}, t = {time}: {pressed}");
            for quantity in ["AUGMENTED_NORMAL_CONTACT_PRESSURE", "DISPLACEMENT_Y"] {
                let off = run.differs(&twin, quantity, time);
                println!("{formulation}, t = {time}: {quantity} off by {off:.1e}");
                assert!(off < TOLERANCE, "{formulation}, t = {time}: {quantity} differs by {off}");
            }
        }
    }
}
