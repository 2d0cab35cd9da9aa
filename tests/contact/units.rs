//! The unit system changes neither the number of iterations nor a digit beyond round-off, in any contact formulation.
//!
//! Every number of a deck that has a unit is rewritten. Absolute tolerances are switched off. Of the settings of contact
//! these have one: `penalty` is a stress over a length and an area (in the plane over two lengths), `scale_factor` a stress
//! over a length.

use crate::support;
use crate::support::{Results, change, read_json, root, said, scratch_copy, zelus};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

const DECK: &str = "ProjectParameters.json";

/// Factors of lengths and stresses.
const UNITS: [(f64, f64); 6] = [(1e3, 1e-6), (1e3, 1.0), (1e-3, 1e6), (1e6, 1.0), (1.0, 1e6), (1.0, 1e-6)];

/// Difference allowed, relative to the largest value of the quantity: coordinates are rounded anew.
const TOLERANCE: f64 = 1e-9;

/// The same for bodies that hang on one or two nodes under a light load: see `renumbering.rs`.
const TOLERANCE_OF_LIGHT_LOADS: f64 = 1e-7;

/// The same where a slave node lies on the axis of revolution: its area is small, and its multiplier a quotient by it.
const TOLERANCE_AT_THE_AXIS: f64 = 5e-9;

/// The same where surfaces slide in space: the decks' tolerance of slip, 1e-9, leaves 1e-8 in the multipliers.
const TOLERANCE_OF_SLIDING: f64 = 3e-8;

/// The reference quantity, by its largest value, and the column that is compared.
const COMPARED: [(&str, &str); 7] = [
    ("DISPLACEMENT", "DISPLACEMENT_X"),
    ("DISPLACEMENT", "DISPLACEMENT_Y"),
    ("DISPLACEMENT", "DISPLACEMENT_Z"),
    ("multiplier", "VECTOR_LAGRANGE_MULTIPLIER_X"),
    ("multiplier", "VECTOR_LAGRANGE_MULTIPLIER_Y"),
    ("multiplier", "VECTOR_LAGRANGE_MULTIPLIER_Z"),
    ("multiplier", "LAGRANGE_MULTIPLIER_CONTACT_PRESSURE"),
];

/// Multiplies a number, or wraps an expression.
fn scaled(value: &Value, factor: f64) -> Value {
    match value {
        Value::Number(number) => json!(number.as_f64().expect("a number") * factor),
        Value::String(text) if text != "End" => match text.parse::<f64>() {
            Ok(number) => json!((number * factor).to_string()),
            Err(_) => match text.split_once(" if ").zip(text.rsplit_once(" else ")) {
                Some(((value, _), (rest, other))) => {
                    let condition = &rest[value.len()..];
                    json!(format!("({value})*{factor:e}{condition} else ({other})*{factor:e}"))
                }
                None => json!(format!("({text})*{factor:e}")),
            },
        },
        Value::Array(items) => items.iter().map(|item| scaled(item, factor)).collect(),
        other => other.clone(),
    }
}

fn write_json(path: &Path, value: &Value) {
    std::fs::write(path, serde_json::to_string_pretty(value).expect("JSON")).expect("a file");
}

/// Rewrites a case in units in which lengths are `length` and stresses `stress` times their numbers.
fn rescale(folder: &Path, length: f64, stress: f64) {
    let mesh = std::fs::read_to_string(folder.join("mesh.mdpa")).expect("the mesh");
    let mut out = String::new();
    let mut nodes = false;
    for line in mesh.lines() {
        nodes = (nodes || line.starts_with("Begin Nodes")) && !line.starts_with("End Nodes");
        let words: Vec<&str> = line.split_whitespace().collect();
        if nodes && words.len() == 4 {
            let x = |i: usize| words[i].parse::<f64>().expect("a coordinate") * length;
            writeln!(out, "{} {:e} {:e} {:e}", words[0], x(1), x(2), x(3)).expect("a string");
        } else {
            writeln!(out, "{line}").expect("a string");
        }
    }
    std::fs::write(folder.join("mesh.mdpa"), out).expect("the mesh");
    let mut materials = read_json(&folder.join("StructuralMaterials.json")).expect("materials");
    for entry in materials["properties"].as_array_mut().expect("a list") {
        for key in ["YOUNG_MODULUS", "TRESCA_FRICTION_THRESHOLD"] {
            if let Some(value) = entry["Material"]["Variables"].get_mut(key) {
                *value = scaled(value, stress);
            }
        }
    }
    write_json(&folder.join("StructuralMaterials.json"), &materials);
    let mut deck = read_json(&folder.join(DECK)).expect("the deck");
    for settings in ["/solver_settings", "/solver_settings/contact_settings"] {
        for (key, value) in deck.pointer_mut(settings).and_then(Value::as_object_mut).into_iter().flatten() {
            if key.ends_with("absolute_tolerance") {
                *value = json!(1e-300);
            }
        }
    }
    let plane = deck["solver_settings"]["domain_size"] == 2;
    for list in deck["processes"].as_object_mut().expect("lists").values_mut() {
        for process in list.as_array_mut().expect("a list") {
            let module = process["python_module"].as_str().expect("a name").to_owned();
            let settings = &mut process["Parameters"];
            match module.as_str() {
                "assign_vector_variable_process" => settings["value"] = scaled(&settings["value"], length),
                "assign_vector_by_direction_to_condition_process" => {
                    settings["modulus"] = scaled(&settings["modulus"], stress);
                }
                "assign_scalar_variable_to_conditions_process" => {
                    settings["value"] = scaled(&settings["value"], stress)
                }
                "mpc_contact_process" | "mesh_tying_process" => {}
                name if name.ends_with("contact_process") => {
                    let line = plane && settings["alternative_formulations"]["axisymmetric"] != true;
                    let counts_gaps = name.starts_with("uzawa") || name.starts_with("perturbed");
                    let area = if line { length } else { length * length };
                    rescale_penalty(settings, if counts_gaps { 1.0 } else { area }, stress / length);
                }
                _ => {}
            }
        }
    }
    write_json(&folder.join(DECK), &deck);
}

/// Rewrites penalty and scale factor of a contact process, where it gives them, for this unit of areas and of stresses over
/// lengths.
fn rescale_penalty(settings: &mut Value, area: f64, stiffness: f64) {
    if let Some(chosen) = settings.get_mut("advance_ALM_parameters") {
        for (key, factor) in [("penalty", stiffness / area), ("scale_factor", stiffness)] {
            if let Some(number) = chosen.get(key).and_then(Value::as_f64) {
                chosen[key] = json!(number * factor);
            }
        }
    }
}

/// A case with changes of its deck.
struct Deck {
    case: &'static str,
    changes: Vec<(&'static str, &'static str)>,
    tolerance: f64,
}

/// Iterations of each step and, by quantity, the values at all nodes over the largest of them.
type UnitOutcome = (Vec<usize>, BTreeMap<String, Vec<f64>>);

impl Deck {
    fn outcome(&self, length: f64, stress: f64) -> Result<UnitOutcome, String> {
        let folder = scratch_copy(&root().join("tests/cases").join(self.case));
        for (find, with) in &self.changes {
            change(folder.path(), DECK, find, with);
        }
        rescale(folder.path(), length, stress);
        let output = zelus(folder.path(), &["run", DECK, "--report", "report.out"]);
        if !output.status.success() {
            return Err(said(&output));
        }
        let report = read_json(&folder.path().join("report.out")).expect("the report");
        let steps = report["steps"].as_array().expect("steps").iter();
        let iterations = steps.map(|step| step["iterations"].as_array().map_or(0, Vec::len)).collect();
        Ok((iterations, values(folder.path())))
    }

    /// Effects of the units, in words.
    fn problems(&self) -> Vec<String> {
        let (iterations, values) = match self.outcome(1.0, 1.0) {
            Ok((iterations, values)) if !values.is_empty() => (iterations, values),
            Ok(_) => return vec![format!("{}: nothing is compared", self.case)],
            Err(said) => return vec![format!("{} {:?}: {said}", self.case, self.changes)],
        };
        let mut problems = Vec::new();
        for (length, stress) in UNITS {
            let place = format!("{} {:?}, lengths x {length:e}, stresses x {stress:e}", self.case, self.changes);
            match self.outcome(length, stress) {
                Err(said) => problems.push(format!("{place}: {said}")),
                Ok((found, _)) if found != iterations => {
                    problems.push(format!("{place}: iterations {found:?}, not {iterations:?}"));
                }
                Ok((_, found)) => {
                    for (quantity, expected) in &values {
                        let pairs = expected.iter().zip(&found[quantity]);
                        let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                        if worst.is_nan() || worst > self.tolerance {
                            problems.push(format!("{place}: {quantity} differs by {worst:.1e}"));
                        }
                    }
                }
            }
        }
        problems
    }
}

/// Displacements and multipliers of all result files. Weighted gaps and slips are left out: closed or stuck, they are
/// round-off.
fn values(folder: &Path) -> BTreeMap<String, Vec<f64>> {
    let mut found: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    let files = support::contents(folder).into_keys().filter(|f| f.extension().is_some_and(|e| e == "json"));
    for results in files.filter_map(|file| Results::read(&folder.join(file)).ok()) {
        for (quantity, name) in COMPARED {
            for step in 0..results.len() {
                found.entry(quantity.to_owned()).or_default().extend(results.nodal(name, step).into_values());
            }
        }
    }
    found.retain(|_, values| values.iter().any(|v| *v != 0.0));
    for values in found.values_mut() {
        let largest = values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        values.iter_mut().for_each(|v| *v /= largest);
    }
    found
}

fn unchanged(decks: impl IntoIterator<Item = Deck>) {
    let problems: Vec<String> = decks.into_iter().flat_map(|deck| deck.problems()).collect();
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

fn as_they_are(cases: &[&'static str]) -> Vec<Deck> {
    cases.iter().map(|&case| Deck { case, changes: Vec::new(), tolerance: TOLERANCE }).collect()
}

fn changed(cases: &[&'static str], changes: &[(&'static str, &'static str)]) -> Vec<Deck> {
    cases.iter().map(|&case| Deck { case, changes: changes.to_vec(), tolerance: TOLERANCE }).collect()
}

const FLAT: [&str; 2] = ["contact_2d/nonmatching", "contact_3d/hexahedra_nonmatching"];

#[test]
fn augmented_lagrangian_without_friction() {
    unchanged(as_they_are(&[
        "contact_2d/nonmatching",
        "contact_2d/opening",
        "contact_2d/free_sides",
        "contact_2d/slope",
        "contact_2d/three_blocks",
        "contact_2d/closing_gap",
        "contact_2d/manual_parameters",
        "contact_3d/hexahedra_nonmatching",
        "contact_3d/free_sides",
        "contact_3d/prisms",
        "contact_3d/tetrahedra",
        "contact_3d/tetrahedra_on_hexahedra",
        "contact_3d/slope",
        "contact_3d/open_sides_in_steps",
    ]));
}

#[test]
fn augmented_lagrangian_by_components() {
    let changes = [
        ("\"ALMContactFrictionless\"", "\"ALMContactFrictionlessComponents\""),
        ("\"contact_type\": \"Frictionless\"", "\"contact_type\": \"FrictionlessComponents\""),
        ("\"LAGRANGE_MULTIPLIER_CONTACT_PRESSURE\"", "\"VECTOR_LAGRANGE_MULTIPLIER\""),
    ];
    unchanged(changed(&FLAT, &changes).into_iter().chain(as_they_are(&["self_contact/slit_components"])));
}

#[test]
fn bodies_of_revolution() {
    let light = "contact_2d/hertz_spheres_light_coarse";
    let light = Deck { case: light, changes: Vec::new(), tolerance: TOLERANCE_OF_LIGHT_LOADS };
    unchanged(as_they_are(&["contact_2d/friction_sleeve"]).into_iter().chain([light]));
    let spheres = "contact_2d/hertz_spheres";
    unchanged([Deck { case: spheres, changes: Vec::new(), tolerance: TOLERANCE_AT_THE_AXIS }]);
}

#[test]
fn sticking_and_sliding() {
    unchanged(as_they_are(&[
        "contact_2d/friction_stick",
        "contact_2d/friction_tresca_stick",
        "contact_2d/friction_slide",
        "contact_2d/friction_slide_millimetres",
        "contact_2d/friction_tresca_slide",
        "contact_2d/friction_by_pair",
        "contact_2d/friction_from_properties",
        "contact_2d/friction_pure_slip",
        "contact_2d/friction_arc",
        "contact_2d/friction_none",
        "contact_2d/friction_perfect_stick",
        "contact_2d/cattaneo_mindlin_light_coarse",
        "contact_3d/friction_stick",
        "contact_3d/friction_iterative_engine",
    ]));
    let slide = |case| Deck { case, changes: Vec::new(), tolerance: TOLERANCE_OF_SLIDING };
    unchanged(["contact_3d/friction_slide", "contact_3d/friction_tresca_slide"].map(slide));
}

#[test]
fn penalty() {
    let gap = ("\"LAGRANGE_MULTIPLIER_CONTACT_PRESSURE\"", "\"WEIGHTED_GAP\"");
    let process = ("\"alm_contact_process\"", "\"penalty_contact_process\"");
    let frictionless = ("\"ALMContactFrictionless\"", "\"PenaltyContactFrictionless\"");
    let frictional = ("\"ALMContactFrictionless\"", "\"PenaltyContactFrictional\"");
    let sliding = "\"contact_type\": \"Frictional\", \"friction_coefficients\": {\"0\": 0.3}";
    unchanged(changed(&FLAT, &[gap, process, frictionless]));
    unchanged(changed(&FLAT, &[gap, process, frictional, ("\"contact_type\": \"Frictionless\"", sliding)]));
}

#[test]
fn uzawa() {
    unchanged(as_they_are(&["contact_2d/uzawa"]));
    unchanged(changed(&["contact_2d/uzawa"], &[("\"manual_ALM\": true", "\"manual_ALM\": false")]));
}

#[test]
fn perturbed_lagrangian() {
    let process = ("\"alm_contact_process\"", "\"perturbed_lagrangian_contact_process\"");
    let formulation = ("\"ALMContactFrictionless\"", "\"PerturbedLagrangianContactFrictionless\"");
    unchanged(changed(&FLAT, &[process, formulation]));
}

#[test]
fn constraints_and_ties() {
    unchanged(as_they_are(&[
        "mpc/pressed_and_opened",
        "mpc/pressed_and_opened_hexahedra",
        "mpc/tying_matching",
        "mpc/tying_matching_hexahedra",
        "mesh_tying/quadrilaterals",
        "mesh_tying/coarse_slave",
        "mesh_tying/hexahedra_on_tetrahedra",
    ]));
}

#[test]
fn self_contact() {
    unchanged(as_they_are(&["self_contact/slit", "self_contact/slit_hexahedra"]));
}
