//! Meshes of other programs as a user meets them: imported, in a deck, and as a deck to start from.

use crate::support;
use std::path::{Path, PathBuf};

use crate::support::{root, said, zelus};
use serde_json::json;
use zelus::{RunOptions, Silent, Simulation};

fn data(name: &str) -> PathBuf {
    root().join("meshes/tests/data").join(name)
}

fn start(from: &str) -> tempfile::TempDir {
    let scratch = tempfile::tempdir().unwrap();
    let mesh = data(from);
    let output = zelus(scratch.path(), &["new", "--from", mesh.to_str().unwrap(), "-o", "deck"]);
    assert!(output.status.success(), "{}", said(&output));
    scratch
}

fn solved(deck: &Path) -> Simulation {
    let mut simulation = Simulation::open(deck, &RunOptions::default()).unwrap();
    while simulation.step(&mut Silent).unwrap() {}
    simulation
}

/// Two blocks of Abaqus, pressed together: stress is the pressure everywhere, and the top goes down by 2 p / E.
#[test]
fn blocks_of_abaqus_are_pressed_together_without_a_hand_s_work() {
    let scratch = start("blocks.inp");
    let simulation = solved(&scratch.path().join("deck/ProjectParameters.json"));
    let part = &simulation.model().parts["Structure"];
    let displacement = simulation.field("DISPLACEMENT").unwrap();
    for (at, point) in part.nodes.initial.iter().enumerate() {
        // the pressure is 10, Young's modulus 1000
        let wanted = match point[2] {
            z if z < 0.5 => 0.0,
            z if z > 1.5 => -0.02,
            _ => -0.01,
        };
        assert!((displacement[3 * at + 2] - wanted).abs() < 1e-8, "{point:?}: {}", displacement[3 * at + 2]);
    }
}

#[test]
fn pairs_are_found_where_a_file_names_none() {
    let scratch = start("solids_1_41.msh");
    let deck = std::fs::read_to_string(scratch.path().join("deck/ProjectParameters.json")).unwrap();
    for word in ["Contact_1_Slave", "Contact_2_Slave", "Structure.Bottom"] {
        assert!(deck.contains(word), "{word} is not in {deck}");
    }
    let output = zelus(&scratch.path().join("deck"), &["check", "ProjectParameters.json"]);
    assert!(output.status.success(), "{}", said(&output));
    let again = zelus(scratch.path(), &["new", "--from", data("solids_1_41.msh").to_str().unwrap(), "-o", "deck"]);
    assert!(!again.status.success() && said(&again).contains("is there already"), "{}", said(&again));
}

/// A deck that names a mesh of Gmsh gives the bits of the one that names the imported file.
#[test]
fn a_deck_names_gmsh_s_file_itself() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    std::fs::copy(data("solids_2_41b.msh"), folder.join("cubes.msh")).unwrap();
    let output = zelus(folder, &["import", "cubes.msh", "--element-name", "TotalLagrangianElement"]);
    assert!(output.status.success(), "{}", said(&output));
    assert!(said(&output).contains("part Bottom"), "{}", said(&output));
    let materials = json!({"properties": [{"model_part_name": "Structure", "properties_id": 1, "Material": {
        "constitutive_law": {"name": "LinearElastic3DLaw"},
        "Variables": {"YOUNG_MODULUS": 1000.0, "POISSON_RATIO": 0.3}, "Tables": {}}}]});
    std::fs::write(folder.join("StructuralMaterials.json"), materials.to_string()).unwrap();
    let hold = |part: &str, value: f64| {
        json!({"python_module": "assign_vector_variable_process", "kratos_module": "KratosMultiphysics", "Parameters": {
            "model_part_name": part, "variable_name": "DISPLACEMENT", "value": [0.0, 0.0, value]}})
    };
    let run = |import: serde_json::Value| {
        let deck = json!({
            "problem_data": {"problem_name": "cubes", "parallel_type": "OpenMP", "start_time": 0.0, "end_time": 1.0},
            "solver_settings": {"solver_type": "Static", "model_part_name": "Structure", "domain_size": 3,
                "model_import_settings": import, "time_stepping": {"time_step": 1.0},
                "material_import_settings": {"materials_filename": "StructuralMaterials.json"}},
            "processes": {"list": [hold("Structure.Tets", 0.01), hold("Structure.Hexes", 0.0), hold("Structure.Top", -0.01)]},
        });
        std::fs::write(folder.join("ProjectParameters.json"), deck.to_string()).unwrap();
        let simulation = solved(&folder.join("ProjectParameters.json"));
        assert!(simulation.report().warnings.iter().all(|said| !said.contains("unknown-key-ignored")));
        simulation.field("DISPLACEMENT").unwrap().to_vec()
    };
    let own = run(json!({"input_type": "gmsh", "input_filename": "cubes", "element_name": "TotalLagrangianElement"}));
    let imported = run(json!({"input_type": "mdpa", "input_filename": "cubes"}));
    assert!(own.iter().any(|u| u.abs() > 0.005) && own == imported);
}

#[test]
fn what_is_no_mesh_is_refused() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    std::fs::write(folder.join("part.msh"), "no mesh").unwrap();
    for (arguments, fact) in [
        (&["import", "part.msh"][..], "error[mesh-syntax] part.msh"),
        (&["import", "nothing.msh"], "there is no mesh file"),
        (&["import", "part.xyz"], "the ending of no mesh format"),
        (&["import", "part.msh", "--format", "gmhs"], "did you mean"),
        (&["convert", "part.msh", "part.msh"], "error[output-file]"),
        (&["new", "--from", "part.msh"], "error[mesh-syntax]"),
    ] {
        let output = zelus(folder, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", said(&output));
        assert!(said(&output).contains(fact), "{arguments:?}: {}", said(&output));
    }
}

/// Two rings of CalculiX, one on the other under a pressure, which is that of the contact.
#[test]
fn contact_of_bodies_of_revolution_counts_the_way_round() {
    let scratch = tempfile::tempdir().unwrap();
    let rings = "*NODE\n1,1,0\n2,2,0\n3,2,1\n4,1,1\n5,1,1\n6,2,1\n7,2,2\n8,1,2\n\
        *ELEMENT,TYPE=CAX4,ELSET=LOWER\n1,1,2,3,4\n*ELEMENT,TYPE=CAX4,ELSET=UPPER\n2,5,6,7,8\n*NSET,NSET=BOTTOM\n1,2\n\
        *SURFACE,NAME=SLO\nLOWER,S3\n*SURFACE,NAME=SUP\nUPPER,S1\n*SURFACE,NAME=STOP\nUPPER,S3\n\
        *MATERIAL,NAME=M\n*ELASTIC\n1000,0.3\n*SOLID SECTION,ELSET=LOWER,MATERIAL=M\n*SOLID SECTION,ELSET=UPPER,MATERIAL=M\n\
        *SURFACE INTERACTION,NAME=I\n*CONTACT PAIR,INTERACTION=I\nSUP,SLO\n\
        *STEP\n*STATIC\n*BOUNDARY\nBOTTOM,2,2\n*DSLOAD\nSTOP,P,10\n*END STEP\n";
    std::fs::write(scratch.path().join("rings.inp"), rings).unwrap();
    for words in [
        &["new", "--from", "rings.inp", "-o", "deck"][..],
        &["run", "deck/ProjectParameters.json", "--report", "run.json"],
    ] {
        let output = zelus(scratch.path(), words);
        assert!(output.status.success(), "{}", said(&output));
    }
    let report = support::read_json(&scratch.path().join("run.json")).unwrap();
    let pressure = report["largest"]["CONTACT_PRESSURE"].as_f64().unwrap();
    assert!((pressure / 10.0 - 1.0).abs() < 0.03, "{pressure}");
}

/// A starter deck of a material that hardly changes its volume has elements that do not lock.
#[test]
fn starter_decks_do_not_lock() {
    const MIXED: &str = "SmallDisplacementMixedVolumetricStrainElement2D4N";
    for (ratio, mixed) in [(0.4999, true), (0.3, false)] {
        let scratch = tempfile::tempdir().unwrap();
        let block = format!(
            "*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n*ELEMENT,TYPE=CPE4,ELSET=BLOCK\n1,1,2,3,4\n*NSET,NSET=BOTTOM\n1,2\n\
             *MATERIAL,NAME=M\n*ELASTIC\n1000,{ratio}\n*SOLID SECTION,ELSET=BLOCK,MATERIAL=M\n*SURFACE,NAME=TOP\nBLOCK,S3\n\
             *STEP\n*STATIC\n*BOUNDARY\nBOTTOM,1,2\n*DSLOAD\nTOP,P,10\n*END STEP\n"
        );
        std::fs::write(scratch.path().join("block.inp"), block).unwrap();
        let output = zelus(scratch.path(), &["new", "--from", "block.inp", "-o", "deck"]);
        assert!(output.status.success(), "{}", said(&output));
        let mesh = std::fs::read_to_string(scratch.path().join("deck/block.mdpa")).unwrap();
        assert_eq!((mesh.contains(MIXED), said(&output).contains("locks")), (mixed, mixed), "{}", said(&output));
        let output = zelus(scratch.path(), &["run", "deck/ProjectParameters.json"]);
        assert!(output.status.success() && !said(&output).contains("[locking]"), "{}", said(&output));
    }
}
