//! Laws of friction that depend on the pressure and on the speed of sliding.

use serde_json::{Value, json};

use crate::blocks::Vec3;
use crate::scene::{FRICTIONAL, Kind, Scene, held};
use crate::support::{Results, read_json, said, zelus};

const DECK: &str = "ProjectParameters.json";
const MATERIALS: &str = "StructuralMaterials.json";
const PENALTY: Kind = ("PenaltyContactFrictional", "Frictional");
const NITSCHE: Kind = ("NitscheContactFrictional", "Frictional");
const SPEED: f64 = 0.4;

/// A block that its upper face presses on a floor and drags along at [`SPEED`], with a law of friction and its numbers: the pressure and
/// the tangential traction of each slave node at the end, or the words of a run that fails.
fn dragged(space: usize, kind: Kind, law: &str, numbers: &Value) -> Result<Vec<[f64; 2]>, String> {
    let mut scene = Scene::new(space);
    (scene.kind, scene.steps, scene.poisson) = (kind, 5, 0.2);
    let up = space - 1;
    let flat = |x: Vec3| if space == 2 { [x[0], x[2], 0.0] } else { x };
    let still = |x: Vec3| x;
    let block = scene.add("Block", [flat([0.0; 3]), flat([2.0, 1.0, 1.0])], 4, &still);
    scene.part("Bottom", &block, &[(up, 0)]);
    scene.part("Top", &block, &[(up, 1)]);
    let floor = scene.add("Floor", [flat([-1.0, -0.5, -1.0]), flat([4.0, 1.5, 0.0])], 5, &still);
    scene.part("Face", &floor, &[(up, 1)]);
    scene.pairs = vec![["Bottom", "Face"]];
    let mut moved = held(space);
    moved[0] = json!(format!("{SPEED}*t"));
    // Pressed from the first step on, so that the last steps differ by a translation alone.
    moved[up] = json!(-0.01);
    scene.supports = vec![("Floor", held(space)), ("Top", moved)];
    let folder = tempfile::tempdir().expect("a scratch folder");
    scene.write(folder.path());
    let change = |name: &str, change: &dyn Fn(&mut Value)| {
        let path = folder.path().join(name);
        let mut value = read_json(&path).expect("it was written");
        change(&mut value);
        std::fs::write(path, value.to_string()).expect("a file");
    };
    change(MATERIALS, &|materials| {
        for material in materials["properties"].as_array_mut().expect("materials") {
            let variables = material["Material"]["Variables"].as_object_mut().expect("variables");
            variables.extend(numbers.as_object().expect("numbers").clone());
        }
    });
    change(DECK, &|deck| {
        let contact = &mut deck["processes"]["contact_process_list"][0];
        contact["Parameters"]["frictional_law"] = json!(law);
        let modules = [(PENALTY, "penalty_contact_process"), (NITSCHE, "nitsche_contact_process")];
        if let Some((_, module)) = modules.iter().find(|(own, _)| *own == kind) {
            contact["python_module"] = json!(module);
        }
        let output = &mut deck["processes"]["json_output_process_list"][0]["Parameters"];
        output["model_part_name"] = json!("Structure.Bottom");
        output["output_variables"] = json!(["CONTACT_PRESSURE", "CONTACT_TRACTION"]);
    });
    let output = zelus(folder.path(), &["run", DECK, "--threads", "1"]);
    if !output.status.success() {
        return Err(said(&output));
    }
    let results = Results::read(&folder.path().join("results.json")).expect("results");
    let last = results.len() - 1;
    let pressure = results.nodal("CONTACT_PRESSURE", last);
    let traction = ["X", "Y", "Z"].map(|axis| results.nodal(&format!("CONTACT_TRACTION_{axis}"), last));
    let node = |(node, pressure): (&u64, &f64)| {
        let whole: f64 = traction.iter().filter_map(|of| of.get(node)).map(|t| t * t).sum();
        [*pressure, (whole - pressure * pressure).max(0.0).sqrt()]
    };
    Ok(pressure.iter().map(node).collect())
}

fn check(found: &[[f64; 2]], what: &str, right: impl Fn(f64) -> f64) {
    assert!(found.iter().filter(|[pressure, _]| *pressure > 0.0).count() > 3, "{what}: {found:?}");
    let largest = found.iter().map(|[_, traction]| *traction).fold(0.0, f64::max);
    for [pressure, traction] in found {
        let off = (traction - right(*pressure)).abs();
        assert!(off < 1e-6 * largest, "{what}: traction {traction:e} under pressure {pressure:e}, off by {off:e}");
    }
}

/// ANALYTIC: every sliding node has the traction min(μ p, τ), under pressures on both sides of τ/μ. The tolerance is that of Newton's
/// iteration.
#[test]
fn orowan_cuts_friction_at_a_shear_stress() {
    let coefficient = 0.4;
    for (space, kind) in [(2, FRICTIONAL), (2, PENALTY), (3, FRICTIONAL)] {
        let what = format!("{kind:?} in {space} dimensions");
        let run = |limit: f64| {
            let numbers = json!({"FRICTION_COEFFICIENT": coefficient, "TRESCA_FRICTION_THRESHOLD": limit});
            dragged(space, kind, "Orowan", &numbers).expect("it runs")
        };
        let free = run(1e3);
        check(&free, &what, |pressure| coefficient * pressure);
        let [low, high] =
            [f64::min, f64::max].map(|of| free.iter().map(|[pressure, _]| *pressure).reduce(of).expect("nodes"));
        let limit = 0.5 * coefficient * (low + high);
        let found = run(limit);
        check(&found, &what, |pressure| (coefficient * pressure).min(limit));
        let is_cut = |[pressure, _]: &[f64; 2]| coefficient * pressure > limit;
        let cut = found.iter().filter(|node| is_cut(node)).count();
        assert!(0 < cut && cut < found.len(), "{what}: {cut} of {} are cut", found.len());
    }
}

/// ANALYTIC: the block slides at a constant speed v in the end, and each node has the traction (μ_k + (μ_s − μ_k) exp(−α v)) p.
#[test]
fn friction_falls_with_the_speed_of_sliding() {
    let [at_rest, kinetic, decay]: [f64; 3] = [0.5, 0.2, 3.0];
    let coefficient = kinetic + (at_rest - kinetic) * (-decay * SPEED).exp();
    for (space, kind) in [(2, FRICTIONAL), (2, PENALTY), (3, FRICTIONAL)] {
        let numbers =
            json!({"FRICTION_COEFFICIENT": at_rest, "KINETIC_FRICTION_COEFFICIENT": kinetic, "FRICTION_DECAY": decay});
        let found = dragged(space, kind, "StaticKinetic", &numbers).expect("it runs");
        check(&found, &format!("{kind:?} in {space} dimensions"), |pressure| coefficient * pressure);
    }
}

#[test]
fn numbers_that_a_law_lacks_are_named() {
    let said = dragged(2, FRICTIONAL, "Orowan", &json!({"FRICTION_COEFFICIENT": 0.3})).expect_err("it lacks one");
    assert!(said.contains("missing-constant") && said.contains("TRESCA_FRICTION_THRESHOLD"), "{said}");
    let numbers = json!({"FRICTION_COEFFICIENT": 0.3, "TRESCA_FRICTION_THRESHOLD": 1.0});
    let said = dragged(2, NITSCHE, "Orowan", &numbers).expect_err("points decide");
    assert!(said.contains("friction-of-nodes"), "{said}");
    let numbers = json!({"FRICTION_COEFFICIENT": 0.3, "TRESCA_FRICTION_THRESHOLD": -1.0});
    let said = dragged(2, FRICTIONAL, "Orowan", &numbers).expect_err("it is negative");
    assert!(said.contains("negative-friction"), "{said}");
}
