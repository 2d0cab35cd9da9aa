//! Contact whose pressure is a function of the overclosure.

use serde_json::{Value, json};

use crate::blocks::Vec3;
use crate::scene::{Kind, Scene, held};
use crate::support::{read_json, said, zelus};
use zelus::contact_structural_mechanics::law::OverclosureLawEntry;
use zelus_core::parameters::Document;
use zelus_core::registry::named;

const DECK: &str = "ProjectParameters.json";
const PERTURBED: (Kind, &str) =
    (("PerturbedLagrangianContactFrictionless", "Frictionless"), "perturbed_lagrangian_contact_process");
const PENALTY: (Kind, &str) = (("PenaltyContactFrictionless", "Frictionless"), "penalty_contact_process");
const FRICTIONAL: (Kind, &str) = (("PenaltyContactFrictional", "Frictional"), "penalty_contact_process");

/// A block that a uniform pressure presses on a floor with a law of soft contact: how far its lower face goes into that of the floor.
fn overclosure(space: usize, (kind, process): (Kind, &str), law: &Value, pressure: f64) -> Result<f64, String> {
    let mut scene = Scene::new(space);
    (scene.kind, scene.steps, scene.poisson) = (kind, 1, 0.0);
    let up = space - 1;
    let flat = |x: Vec3| if space == 2 { [x[0], x[2], 0.0] } else { x };
    let still = |x: Vec3| x;
    let block = scene.add("Block", [flat([0.0; 3]), flat([2.0, 1.0, 1.0])], 3, &still);
    scene.part("Bottom", &block, &[(up, 0)]);
    scene.load("Top", &block, (up, 1), flat([0.0, 0.0, -pressure]));
    let floor = scene.add("Floor", [flat([-1.0, -0.5, -1.0]), flat([3.0, 1.5, 0.0])], 4, &still);
    scene.part("Face", &floor, &[(up, 1)]);
    scene.pairs = vec![["Bottom", "Face"]];
    for side in (0..up).flat_map(|axis| [(axis, 0), (axis, 1)]) {
        let name: &'static str = ["West", "East", "South", "North"][2 * side.0 + side.1];
        scene.part(name, &block, &[side]);
        scene.supports.push((name, std::array::from_fn(|c| if c == side.0 { json!(0.0) } else { Value::Null })));
    }
    scene.supports.push(("Floor", held(space)));
    scene.friction = if kind == FRICTIONAL.0 { 0.3 } else { 0.0 };
    let folder = tempfile::tempdir().expect("a scratch folder");
    scene.write(folder.path());
    let path = folder.path().join(DECK);
    let mut deck = read_json(&path).expect("it was written");
    let contact = &mut deck["processes"]["contact_process_list"][0];
    contact["python_module"] = json!(process);
    contact["Parameters"]["pressure_overclosure"] = law.clone();
    std::fs::write(path, deck.to_string()).expect("a file");
    let output = zelus(folder.path(), &["run", DECK, "--threads", "1"]);
    if !output.status.success() {
        return Err(said(&output));
    }
    let results = crate::support::Results::read(&folder.path().join("results.json")).expect("results");
    let last = results.nodal(["DISPLACEMENT_Y", "DISPLACEMENT_Z"][up - 1], results.len() - 1);
    let below: Vec<f64> = block[&(up, 0)].0.iter().map(|&node| -last[&(node as u64)]).collect();
    let mean = below.iter().sum::<f64>() / below.len() as f64;
    assert!(below.iter().all(|own| (own - mean).abs() < 1e-9), "it stays plane: {below:?}");
    Ok(mean)
}

/// ANALYTIC: the depth of the law under the pressure of the load, on each row of a table, before surfaces touch and after, by every
/// formulation that has the law. The tolerance is that of Newton's iteration.
#[test]
fn surfaces_close_as_the_law_says() {
    let laws = [
        json!({"law": "table", "rows": [[-0.004, 0.0], [0.002, 0.5], [0.01, 4.0], [0.012, 30.0]]}),
        json!({"law": "exponential", "pressure": 2.0, "clearance": 0.005}),
    ];
    for law in laws {
        let text = law.to_string();
        let (entry, settings) =
            named::<OverclosureLawEntry>(&Document::from_str(&text, "law.json").expect("JSON").root, "law")
                .expect("a law");
        let exact = (entry.build)(&settings).expect("a law");
        for (space, formulation, pressure) in [
            (2, PERTURBED, 0.2),
            (2, PERTURBED, 3.0),
            (2, PENALTY, 0.2),
            (2, PENALTY, 20.0),
            (2, FRICTIONAL, 3.0),
            (3, PENALTY, 6.0),
        ] {
            let found = overclosure(space, formulation, &law, pressure).expect("it runs");
            let right = exact.overclosure(pressure).depth;
            let off = (found - right).abs() / 0.01;
            assert!(off < 1e-7, "{formulation:?}, {law} under {pressure}: {found:e} in place of {right:e}");
        }
    }
}

#[test]
fn mistakes_in_a_law_are_named() {
    for (law, words) in [
        (json!({"law": "tabel"}), "\"table\""),
        (json!({"law": "table", "rows": [[0.0, 0.0], [0.1, 1.0], [0.05, 2.0]]}), "growing from row to row"),
        (json!({"law": "exponential", "pressure": -1.0, "clearance": 0.1}), "pressure"),
    ] {
        let said = overclosure(2, PENALTY, &law, 1.0).expect_err("it is wrong");
        assert!(said.contains(words), "{law}: {said}");
    }
}
