//! Every contact formulation with every setting that may not suit it: it runs, or is refused with the reason that
//! `compatibility` states.

use crate::support::{read_json, root, said, scratch_copy, zelus};
use serde_json::{Value, json};
use std::path::Path;
use zelus::contact_structural_mechanics::compatibility::{FormulationUse, refusal};
use zelus::contact_structural_mechanics::pairs::{Formulation, FormulationEntry, Friction};
use zelus_core::registry::all;

const DECK: &str = "ProjectParameters.json";
const VARIATIONS: [&str; 4] = [
    "no_derivatives_computation",
    "no_derivatives_computation_with_normal_update",
    "elemental_derivatives",
    "nodal_elemental_derivatives",
];

fn formulations() -> Vec<(&'static str, &'static Formulation)> {
    all::<FormulationEntry>().into_iter().map(|entry| (entry.name, &entry.build)).collect()
}

/// The process of a formulation and the contact type that names it there.
fn process_of(formulation: &str, explicit: bool) -> (&'static str, &str) {
    let processes = [
        ("ALMContact", "alm_contact_process"),
        ("PenaltyContact", if explicit { "explicit_penalty_contact_process" } else { "penalty_contact_process" }),
        ("UzawaContact", "uzawa_contact_process"),
        ("NitscheContact", "nitsche_contact_process"),
        ("PerturbedLagrangianContact", "perturbed_lagrangian_contact_process"),
    ];
    let found = processes.iter().find_map(|(stem, process)| Some((*process, formulation.strip_prefix(stem)?)));
    found.unwrap_or_else(|| panic!("no process for {formulation}"))
}

/// Further settings that a deck asks for.
#[derive(Debug, Clone, Copy)]
struct Wish {
    wanted: FormulationUse,
    variation: &'static str,
    dynamic: bool,
    tresca: bool,
    adapt_penalty: bool,
}

fn replace(folder: &Path, file: &str, pairs: &[(&str, &str)]) {
    let path = folder.join(file);
    let text = std::fs::read_to_string(&path).expect("a file");
    std::fs::write(path, pairs.iter().fold(text, |text, (from, to)| text.replace(from, to))).expect("a file");
}

fn check(name: &str, formulation: &Formulation, wish: Wish) {
    let FormulationUse { dimension, axisymmetric, explicit, arc_length } = wish.wanted;
    let case = if dimension == 2 { "contact_2d/nonmatching" } else { "contact_3d/hexahedra_nonmatching" };
    let scratch = scratch_copy(&root().join("tests/cases").join(case));
    if axisymmetric && dimension == 2 {
        replace(
            scratch.path(),
            "mesh.mdpa",
            &[
                ("SmallDisplacementElement2D4N", "AxisymSmallDisplacementElement2D4N"),
                ("LineLoadCondition2D2N", "AxisymLineLoadCondition2D2N"),
            ],
        );
        replace(scratch.path(), "StructuralMaterials.json", &[("PlaneStrain2DLaw", "Axisym2DLaw")]);
    }
    let density = ("\"POISSON_RATIO\"", "\"DENSITY\": 1e3, \"TRESCA_FRICTION_THRESHOLD\": 1e4, \"POISSON_RATIO\"");
    replace(scratch.path(), "StructuralMaterials.json", &[density]);
    let path = scratch.path().join(DECK);
    let mut deck = read_json(&path).expect("the deck");
    let (process, contact_type) = process_of(name, explicit);
    let solver = &mut deck["solver_settings"];
    solver["contact_settings"]["mortar_type"] = json!(name);
    if arc_length {
        solver["solving_strategy_settings"] = json!({"type": "arc_length", "advanced_settings": {}});
    }
    if explicit || wish.dynamic {
        solver["solver_type"] = json!("Dynamic");
        solver["time_integration_method"] = json!(if explicit { "explicit" } else { "implicit" });
        // Short implicit steps would make bodies so stiff by their mass that Uzawa's iteration takes long.
        let time_step = if explicit { 1e-5 } else { 1e-2 };
        solver["time_stepping"]["time_step"] = json!(time_step);
        deck["problem_data"]["end_time"] = json!(3.0 * time_step);
    }
    let contact = &mut deck["processes"]["contact_process_list"][0];
    contact["python_module"] = json!(process);
    let settings = &mut contact["Parameters"];
    settings["contact_type"] = json!(contact_type);
    settings["normal_variation"] = json!(wish.variation);
    settings["alternative_formulations"] = json!({"axisymmetric": axisymmetric});
    settings["advance_ALM_parameters"] = json!({"adapt_penalty": wish.adapt_penalty});
    if formulation.friction != Friction::None {
        // Sliding without a choice has no answer with friction where nothing can slide.
        let coefficient = if formulation.friction == Friction::PureSlip { 0.0 } else { 0.3 };
        settings["friction_coefficients"] = json!({"0": coefficient});
        settings["frictional_law"] = json!(if wish.tresca { "Tresca" } else { "Coulomb" });
    }
    deck["processes"]["json_output_process_list"] = json!([{
        "python_module": "json_output_process", "kratos_module": "KratosMultiphysics", "Parameters": {
            "output_file_name": "results.json", "model_part_name": "Structure", "output_variables": ["REACTION"],
            "time_frequency": 0.0}}]);
    std::fs::write(&path, serde_json::to_string(&Value::clone(&deck)).expect("JSON")).expect("the deck");
    let output = zelus(scratch.path(), &["run", DECK]);
    let said = said(&output);
    match refusal(formulation, wish.wanted) {
        None => {
            assert!(output.status.success(), "{name} {wish:?}\n{said}");
            if !explicit && !wish.dynamic {
                check_balance(scratch.path(), wish.wanted, &format!("{name} {wish:?}"));
            }
        }
        Some(refusal) => {
            assert_eq!(output.status.code(), Some(2), "{name} {wish:?}\n{said}");
            assert!(said.contains(refusal.reason), "{name} {wish:?}\n{said}");
        }
    }
}

/// Contact hands the whole load on to the supports: 1e6 on a top of unit width, of 1 by 0.8, or of radius 1 about the axis.
fn check_balance(folder: &Path, wanted: FormulationUse, what: &str) {
    let results = read_json(&folder.join("results.json")).expect("results");
    let along = if wanted.dimension == 2 { "REACTION_Y" } else { "REACTION_Z" };
    let load = match wanted {
        FormulationUse { dimension: 3, .. } => 0.8e6,
        FormulationUse { axisymmetric: true, .. } => std::f64::consts::PI * 1e6,
        _ => 1e6,
    };
    let of_node = |series: &Value| series.get(along).and_then(|values| values.as_array()?.last()?.as_f64());
    let borne: f64 = results.as_object().expect("nodes").values().filter_map(of_node).sum();
    assert!((borne - load).abs() < 1e-6 * load, "{what}: the supports bear {borne} of {load}");
}

fn plain(dimension: usize) -> Wish {
    let wanted = FormulationUse { dimension, axisymmetric: false, explicit: false, arc_length: false };
    Wish { wanted, variation: VARIATIONS[0], dynamic: false, tresca: false, adapt_penalty: false }
}

#[test]
fn every_formulation_runs_with_every_variation_of_normals() {
    for (name, formulation) in formulations() {
        for variation in VARIATIONS {
            check(name, formulation, Wish { variation, ..plain(2) });
            check(name, formulation, Wish { variation, ..plain(3) });
        }
    }
}

#[test]
fn every_formulation_runs_or_is_refused_about_an_axis_in_time_and_adapted() {
    for (name, formulation) in formulations() {
        for dimension in [2, 3] {
            let plain = plain(dimension);
            check(name, formulation, Wish { wanted: FormulationUse { axisymmetric: true, ..plain.wanted }, ..plain });
            check(name, formulation, Wish { wanted: FormulationUse { explicit: true, ..plain.wanted }, ..plain });
            check(name, formulation, Wish { wanted: FormulationUse { arc_length: true, ..plain.wanted }, ..plain });
            check(name, formulation, Wish { dynamic: true, ..plain });
            check(name, formulation, Wish { adapt_penalty: true, ..plain });
            if formulation.friction == Friction::Coulomb {
                check(name, formulation, Wish { tresca: true, ..plain });
            }
        }
    }
}
