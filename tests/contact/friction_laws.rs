//! Laws of friction that depend on the pressure and on the speed of sliding.

use std::collections::BTreeMap;

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
    let all = dragged_by((space, kind), (law, numbers), &json!({}), (SPEED, 5))?;
    let node =
        |(pressure, [x, y, z]): (f64, Vec3)| [pressure, (x * x + y * y + z * z - pressure * pressure).max(0.0).sqrt()];
    Ok(all.into_iter().map(|(pressure, traction, _)| node((pressure, traction))).collect())
}

/// As [`dragged`], with further parameters of the process and another way, in so many steps: pressures, tractions on the block, and slips of the last step.
fn dragged_by(
    (space, kind): (usize, Kind),
    (law, numbers): (&str, &Value),
    extra: &Value,
    (way, steps): (f64, usize),
) -> Result<Vec<(f64, Vec3, Vec3)>, String> {
    let mut scene = Scene::new(space);
    (scene.kind, scene.steps, scene.poisson) = (kind, steps, 0.2);
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
    moved[0] = json!(format!("{way}*t"));
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
        let parameters = contact["Parameters"].as_object_mut().expect("parameters");
        parameters.insert("frictional_law".to_owned(), json!(law));
        parameters.extend(extra.as_object().expect("parameters").clone());
        let modules = [(PENALTY, "penalty_contact_process"), (NITSCHE, "nitsche_contact_process")];
        if let Some((_, module)) = modules.iter().find(|(own, _)| *own == kind) {
            contact["python_module"] = json!(module);
        }
        let output = &mut deck["processes"]["json_output_process_list"][0]["Parameters"];
        output["model_part_name"] = json!("Structure.Bottom");
        output["output_variables"] = json!(["CONTACT_PRESSURE", "CONTACT_TRACTION", "CONTACT_SLIP"]);
    });
    let output = zelus(folder.path(), &["run", DECK, "--threads", "1"]);
    if !output.status.success() {
        return Err(said(&output));
    }
    let results = Results::read(&folder.path().join("results.json")).expect("results");
    let last = results.len() - 1;
    let pressure = results.nodal("CONTACT_PRESSURE", last);
    let of = |name: &str| ["X", "Y", "Z"].map(|axis| results.nodal(&format!("{name}_{axis}"), last));
    let (traction, slip) = (of("CONTACT_TRACTION"), of("CONTACT_SLIP"));
    let part = |of: &[BTreeMap<u64, f64>; 3], node: &u64| of.each_ref().map(|of| of.get(node).copied().unwrap_or(0.0));
    Ok(pressure.iter().map(|(node, pressure)| (*pressure, part(&traction, node), part(&slip, node))).collect())
}

fn check(found: &[[f64; 2]], what: &str, right: impl Fn(f64) -> f64) {
    assert!(found.iter().filter(|[pressure, _]| *pressure > 0.0).count() > 3, "{what}: {found:?}");
    let largest = found.iter().map(|[_, traction]| *traction).fold(0.0, f64::max);
    for [pressure, traction] in found {
        let off = (traction - right(*pressure)).abs();
        assert!(off < 1e-6 * largest, "{what}: traction {traction:e} under pressure {pressure:e}, off by {off:e}");
    }
}

/// ANALYTIC: between two states of steady sliding, alike but for a translation, each node slips by that, however many facets it crosses.
/// The tolerance is that of the deflection in the first steps, which comes to rest in the later ones.
#[test]
fn slips_of_steps_longer_than_a_facet_are_whole() {
    for (space, steps) in [(2, 2), (2, 20), (3, 2)] {
        let numbers = json!({"FRICTION_COEFFICIENT": 0.3});
        let way = 1.7;
        let found = dragged_by((space, FRICTIONAL), ("Coulomb", &numbers), &json!({}), (way, steps)).expect("it runs");
        let pressed = found.iter().filter(|(pressure, ..)| *pressure > 0.0);
        assert!(pressed.clone().count() > 3, "{found:?}");
        for (_, _, [x, y, z]) in pressed {
            let slip = (x * x + y * y + z * z).sqrt();
            assert!((slip / (way / steps as f64) - 1.0).abs() < 1e-4, "{space}D, {steps} steps: a slip of {slip}");
        }
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

/// ANALYTIC: a block under the pressure p that is dragged on a floor of another temperature, both of which rise in time. The force is
/// μ₀ (1 − θ²) p A at the mean of both temperatures, by hand; that of Newton's iteration.
#[test]
fn friction_falls_with_the_temperature_of_both_surfaces() {
    for (space, kind, swapped) in
        [(2, FRICTIONAL, false), (2, PENALTY, false), (2, FRICTIONAL, true), (3, FRICTIONAL, false)]
    {
        let what = format!("{kind:?} in {space} dimensions, swapped {swapped}");
        let forces = warm(space, kind, swapped, &WARM, true).expect("it runs");
        // Area 2, pressure 5 t; temperatures 100 t and 40 t − 20.
        for (at, force) in forces.iter().enumerate() {
            let t = (at + 1) as f64 / 5.0;
            let softened = ((0.5 * (100.0 * t + 40.0 * t - 20.0) + 20.0) / 160.0).clamp(0.0, 1.0);
            let right = 0.4 * (1.0 - softened * softened) * 5.0 * t * 2.0;
            assert!((force - right).abs() < 1e-6 * right, "{what}, step {at}: {force} {right}");
        }
    }
}

/// Numbers of [`warm`]'s law: from −20 to 140 degrees.
const WARM: [f64; 4] = [0.4, 2.0, -20.0, 140.0];

/// The force that drags a block under a growing pressure, by step, with friction that softens by these numbers; with heat, the block
/// has the temperature 100 t and the floor 40 t − 20.
fn warm(space: usize, kind: Kind, swapped: bool, numbers: &[f64; 4], heat: bool) -> Result<Vec<f64>, String> {
    let mut scene = Scene::new(space);
    (scene.kind, scene.steps, scene.poisson) = (kind, 5, 0.0);
    let up = space - 1;
    let flat = |x: Vec3| if space == 2 { [x[0], x[2], 0.0] } else { x };
    let still = |x: Vec3| x;
    let block = scene.add("Block", [flat([0.0; 3]), flat([2.0, 1.0, 1.0])], 4, &still);
    scene.part("Bottom", &block, &[(up, 0)]);
    let down = std::array::from_fn(|c| if c == up { -5.0 } else { 0.0 });
    scene.load("Top", &block, (up, 1), down);
    let floor = scene.add("Floor", [flat([-1.0, -0.5, -1.0]), flat([4.0, 1.5, 0.0])], 5, &still);
    scene.part("Face", &floor, &[(up, 1)]);
    scene.pairs = vec![if swapped { ["Face", "Bottom"] } else { ["Bottom", "Face"] }];
    let mut moved = held(space);
    (moved[0], moved[up]) = (json!(format!("{SPEED}*t")), Value::Null);
    scene.supports = vec![("Floor", held(space)), ("Block", moved)];
    let of_block = 5_u64.pow(space as u32);
    let folder = tempfile::tempdir().expect("a scratch folder");
    scene.write(folder.path());
    let change = |name: &str, change: &dyn Fn(&mut Value)| {
        let path = folder.path().join(name);
        let mut value = read_json(&path).expect("it was written");
        change(&mut value);
        std::fs::write(path, value.to_string()).expect("a file");
    };
    let names = [
        "FRICTION_COEFFICIENT",
        "FRICTION_SOFTENING_EXPONENT",
        "FRICTION_REFERENCE_TEMPERATURE",
        "FRICTION_MELTING_TEMPERATURE",
    ];
    change(MATERIALS, &|materials| {
        for material in materials["properties"].as_array_mut().expect("materials") {
            let variables = material["Material"]["Variables"].as_object_mut().expect("variables");
            variables.extend(names.iter().zip(numbers).map(|(name, number)| ((*name).to_owned(), json!(number))));
        }
    });
    let conducts = |at: usize, name: &str| {
        json!({"model_part_name": format!("Heat.{name}"), "properties_id": at, "Material": {
            "Variables": {"DENSITY": 1.0, "SPECIFIC_HEAT": 1.0, "CONDUCTIVITY": 1.0}, "Tables": {}}})
    };
    let thermal = json!({"properties": [conducts(1, "Block"), conducts(2, "Floor")]});
    std::fs::write(folder.path().join("heat.json"), thermal.to_string()).expect("a file");
    change(DECK, &|deck| {
        let contact = &mut deck["processes"]["contact_process_list"][0];
        contact["Parameters"]["frictional_law"] = json!("ThermalSoftening");
        if kind == PENALTY {
            contact["python_module"] = json!("penalty_contact_process");
        }
        if !heat {
            return;
        }
        let structure = deck["solver_settings"].take();
        let thermal = json!({"solver_type": "stationary", "model_part_name": "Heat", "domain_size": space,
            "model_import_settings": {"input_type": "use_input_model_part"},
            "material_import_settings": {"materials_filename": "heat.json"},
            "time_stepping": structure["time_stepping"],
            "element_replace_settings": {"element_name": "LaplacianElement"}});
        deck["solver_settings"] = json!({"solver_type": "ThermoMechanicallyCoupled", "domain_size": space,
            "structural_solver_settings": structure, "thermal_solver_settings": thermal});
        let hold = |part: &str, value: &str| {
            json!({"python_module": "assign_scalar_variable_process", "Parameters": {
                "model_part_name": format!("Heat.{part}"), "variable_name": "TEMPERATURE", "value": value,
                "interval": [0.0, "End"]}})
        };
        deck["processes"]["heat"] = json!([hold("Block", "100*t"), hold("Floor", "40*t - 20")]);
    });
    let output = zelus(folder.path(), &["run", DECK, "--threads", "1"]);
    if !output.status.success() {
        return Err(said(&output));
    }
    let results = Results::read(&folder.path().join("results.json")).expect("results");
    let force = |at: usize| (1..=of_block).map(|node| results.nodal("REACTION_X", at)[&node]).sum();
    Ok((0..results.len()).map(force).collect())
}

#[test]
fn mistakes_in_friction_by_temperature_are_named() {
    let said = warm(2, FRICTIONAL, false, &WARM, false).expect_err("there is no temperature");
    assert!(said.contains("error[friction-temperature]"), "{said}");
    for (numbers, words) in
        [([0.4, 0.0, 0.0, 9.0], "FRICTION_SOFTENING_EXPONENT"), ([0.4, 1.0, 9.0, 9.0], "must be above")]
    {
        let said = warm(2, FRICTIONAL, false, &numbers, true).expect_err("it is wrong");
        assert!(said.contains(words), "{said}");
    }
}

/// ANALYTIC: a block that slides along x, over a floor with unlike coefficients along a and across it. With multipliers each sliding node
/// has the traction −μ p D e/√(e·D e), D = ρ² I + (1 − ρ²) a⊗a, e along x: the slip is normal to the elliptic limit. Exact but for Newton's
/// iteration, and for the block's first steps: its deflection across the motion comes to rest by a factor of 20 a step.
#[test]
fn multipliers_slide_normal_to_the_ellipse() {
    let (friction, ratio) = (0.4, 0.5);
    let numbers = json!({"FRICTION_COEFFICIENT": friction});
    for angle in [0.0, 0.5, 1.2, -0.8, 1.5] {
        let axis: Vec3 = [f64::cos(angle), f64::sin(angle), 0.0];
        let extra = json!({"friction_direction": axis.map(|c| 3.0 * c), "friction_ratio": ratio});
        let found = dragged_by((3, FRICTIONAL), ("Coulomb", &numbers), &extra, (1.9, 8)).expect("it runs");
        let square = ratio * ratio;
        let product = [square + (1.0 - square) * axis[0] * axis[0], (1.0 - square) * axis[0] * axis[1]];
        let largest = found.iter().map(|(pressure, ..)| *pressure).fold(0.0, f64::max);
        assert!(found.iter().filter(|(pressure, ..)| *pressure > 0.0).count() > 10, "{found:?}");
        for (pressure, traction, _) in found {
            for c in 0..2 {
                let right = -friction * pressure * product[c] / product[0].sqrt();
                let off = (traction[c] - right).abs();
                assert!(off < 1e-6 * friction * largest, "angle {angle}: {traction:?} under {pressure}, {right}");
            }
        }
    }
}

#[test]
fn mistakes_in_friction_by_direction_are_named() {
    let numbers = json!({"FRICTION_COEFFICIENT": 0.3});
    let run = |space: usize, extra: Value| {
        dragged_by((space, FRICTIONAL), ("Coulomb", &numbers), &extra, (SPEED, 1)).expect_err("it is wrong")
    };
    let direction = [1.0, 0.0, 0.0];
    let said = run(2, json!({"friction_direction": direction}));
    assert!(said.contains("error[surface-law]") && said.contains("model in space"), "{said}");
    let said = run(3, json!({"friction_direction": direction, "augmentation": "pair"}));
    assert!(said.contains("error[surface-law]") && said.contains("\"augmentation\": \"node\""), "{said}");
    let said = run(3, json!({"friction_direction": direction, "friction_ratio": 0.0}));
    assert!(said.contains("friction_ratio"), "{said}");
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
