//! Decks whose mesh comes by modelers: geometries of the mesh file, with elements and conditions made on them.

use crate::support::{Results, change, read_json, root, said, scratch_copy, zelus};
use serde_json::{Value, json};
use std::path::Path;

const DECK: &str = "ProjectParameters.json";
const MODELER: &str = "Modelers.KratosMultiphysics";

/// The mesh with geometries in place of elements and conditions, whose ids follow those of the elements.
fn as_geometries(mesh: &str) -> String {
    let conditions_from = 1000;
    let mut out = String::new();
    let mut shift = None;
    for line in mesh.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["Begin", kind @ ("Elements" | "Conditions"), name] => {
                shift = Some(if kind == "Elements" { 0 } else { conditions_from });
                let geometry = if name.starts_with("Small") { "Hexahedra3D8" } else { "Quadrilateral3D4" };
                out.push_str(&format!("Begin Geometries {geometry}\n"));
            }
            ["End", "Elements" | "Conditions"] => {
                shift = None;
                out.push_str("End Geometries\n");
            }
            ["Begin", kind @ ("SubModelPartElements" | "SubModelPartConditions")] => {
                shift = Some(if kind == "SubModelPartElements" { 0 } else { conditions_from });
                out.push_str("Begin SubModelPartGeometries\n");
            }
            ["End", "SubModelPartElements" | "SubModelPartConditions"] => {
                shift = None;
                out.push_str("End SubModelPartGeometries\n");
            }
            [id, properties, ref nodes @ ..] if shift.is_some() && out.lines().last().is_some_and(in_block) => {
                let id = id.parse::<u64>().expect("an id") + shift.expect("in a block");
                assert_eq!(properties, "0", "a column of properties");
                out.push_str(&format!("{id} {}\n", nodes.join(" ")));
            }
            _ => match shift {
                Some(shift) => words.iter().for_each(|id| {
                    out.push_str(&format!("{}\n", id.parse::<u64>().expect("an id") + shift));
                }),
                None => out.push_str(&format!("{line}\n")),
            },
        }
    }
    out
}

/// Whether the line opens or continues a block of geometries of the mesh, not one of a sub part.
fn in_block(line: &str) -> bool {
    line.starts_with("Begin Geometries") || line.split(' ').count() > 4
}

fn modelers(elements: &str) -> Value {
    let element = |part| json!({"model_part_name": part, "element_name": elements});
    let condition = |part, name| json!({"model_part_name": part, "condition_name": name});
    json!([
        {"name": format!("{MODELER}.ImportMDPAModeler"),
         "parameters": {"input_filename": "mesh", "model_part_name": "Structure"}},
        {"name": format!("{MODELER}.CreateEntitiesFromGeometriesModeler"), "parameters": {
            "elements_list": [element("Structure.Lower"), element("Structure.Upper")],
            "conditions_list": [
                condition("Structure.Interface", "SurfaceCondition3D4N"),
                condition("Structure.Top", "SurfaceLoadCondition#D#N"),
                condition("Structure.Left", "SurfaceLoadCondition3D3N;SurfaceLoadCondition3D4N"),
                condition("Structure.Right", "SurfaceLoadCondition3D4N")]}}])
}

/// The case with modelers, in a scratch folder.
fn modelled(elements: &str, change_deck: impl Fn(&mut Value)) -> tempfile::TempDir {
    let scratch = scratch_copy(&root().join("tests/cases/contact_3d/friction_stick"));
    let mesh = std::fs::read_to_string(scratch.path().join("mesh.mdpa")).expect("the mesh");
    std::fs::write(scratch.path().join("mesh.mdpa"), as_geometries(&mesh)).expect("the mesh");
    let mut deck = read_json(&scratch.path().join(DECK)).expect("the deck");
    deck["modelers"] = modelers(elements);
    deck["solver_settings"]["model_import_settings"] = json!({"input_type": "use_input_model_part"});
    change_deck(&mut deck);
    std::fs::write(scratch.path().join(DECK), deck.to_string()).expect("the deck");
    scratch
}

fn displacements(folder: &Path) -> Vec<f64> {
    let files = ["lower.json", "upper.json"].map(|file| Results::read(&folder.join(file)).expect("results"));
    let axes = ["DISPLACEMENT_X", "DISPLACEMENT_Y", "DISPLACEMENT_Z"];
    let of = |file: &Results| axes.map(|axis| file.nodal(axis, file.len() - 1).into_values().collect::<Vec<_>>());
    files.iter().flat_map(of).flatten().collect()
}

/// The same elements and conditions on the same nodes are the same system: equal but for the order of sums.
#[test]
fn a_mesh_of_geometries_gives_what_one_of_elements_gives() {
    let plain = scratch_copy(&root().join("tests/cases/contact_3d/friction_stick"));
    let output = zelus(plain.path(), &["run", DECK]);
    assert!(output.status.success(), "{}", said(&output));
    let expected = displacements(plain.path());
    let scale = expected.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    let in_stage = |deck: &mut Value| {
        let list = deck.as_object_mut().expect("an object").remove("modelers").expect("the modelers");
        *deck = json!({"orchestrator": {"name": "Orchestrators.KratosMultiphysics.SequentialOrchestrator",
                "settings": {"execution_list": ["press"]}},
            "stages": {"press": {"stage_preprocess": {"modelers": list}, "stage_settings": deck.clone()}}});
    };
    let decks = [
        ("by name", modelled("SmallDisplacementElement3D8N", |_| ())),
        ("by pattern", modelled("SmallDisplacementElement#D#N", |_| ())),
        ("before a stage", modelled("SmallDisplacementElement3D8N", in_stage)),
    ];
    for (form, scratch) in decks {
        let output = zelus(scratch.path(), &["run", DECK]);
        assert!(output.status.success(), "{form}: {}", said(&output));
        assert!(!said(&output).contains("unused-block"), "{form}: {}", said(&output));
        let found = displacements(scratch.path());
        assert_eq!(found.len(), expected.len(), "{form}");
        let worst = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst <= 1e-12 * scale, "{form}: {worst:e} of {scale:e}");
    }
}

#[test]
fn what_modelers_cannot_do_is_said() {
    let name = "SmallDisplacementElement3D8N";
    let said_of = |scratch: &tempfile::TempDir| {
        let output = zelus(scratch.path(), &["check", DECK]);
        (output.status.code(), said(&output))
    };
    type Change = fn(&mut Value);
    let refused: [(Change, &str); 6] = [
        (|deck| deck["modelers"][0]["name"] = json!("Modelers.ImportMDPA"), "there is no modeler \"ImportMDPA\""),
        (|deck| deck["modelers"][0]["parameters"]["input_filename"] = json!("other"), "there is no mesh file"),
        (|deck| deck["modelers"][0]["parameters"]["model_part_name"] = json!(""), "name the root part"),
        (
            |deck| deck["modelers"][1]["parameters"]["elements_list"][0]["element_name"] = json!("Solid#D#N"),
            "no element has",
        ),
        (
            |deck| deck["modelers"][1]["parameters"]["elements_list"][1]["model_part_name"] = json!("Structure.Lower"),
            "has 50 elements already",
        ),
        (|deck| deck["modelers"] = json!([]), "no earlier stage and no modeler has made"),
    ];
    for (change, words) in refused {
        let (code, said) = said_of(&modelled(name, change));
        assert_eq!(code, Some(2), "{said}");
        assert!(said.contains(words), "no {words:?} in {said}");
    }
    let (_, said) = said_of(&modelled("TotalLagrangianElement3D4N", |_| ()));
    assert!(said.contains("has the shape of TotalLagrangianElement3D4N"), "{said}");
    let scratch = scratch_copy(&root().join("tests/cases/contact_3d/friction_stick"));
    change(scratch.path(), "mesh.mdpa", "End Nodes", "End Nodes\nBegin Geometries Line3D2\n1 1 2\nEnd Geometries");
    let (code, said) = said_of(&scratch);
    assert!(code == Some(0) && said.contains("makes elements and conditions on them"), "{said}");
}
