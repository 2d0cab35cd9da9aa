//! Meshes of other programs as a user meets them: imported, in a deck, and as a deck to start from.

use crate::support;
use std::path::{Path, PathBuf};

use crate::support::{read_json, root, said, zelus};
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

/// Names that open and close blocks of a mesh file, or have spaces, are names of parts.
#[test]
fn any_name_of_a_physical_group_is_a_part() {
    let scratch = tempfile::tempdir().unwrap();
    let mesh = std::fs::read_to_string(data("pyramids_1.msh")).unwrap();
    for (deck, name) in [("a", "End"), ("b", "Begin"), ("c", "Top Face")] {
        std::fs::write(scratch.path().join("body.msh"), mesh.replace("\"Skin\"", &format!("\"{name}\""))).unwrap();
        let output = zelus(scratch.path(), &["new", "--from", "body.msh", "--fix", name, "-o", deck]);
        assert!(output.status.success(), "{name}: {}", said(&output));
        let output = zelus(&scratch.path().join(deck), &["check", "ProjectParameters.json"]);
        assert!(output.status.success(), "{name}: {}", said(&output));
    }
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

/// ANALYTIC: the same blocks with soft contact: the upper one goes down further by the overclosure of the pressure, 10.
#[test]
fn soft_contact_of_abaqus_gives_way() {
    let blocks = std::fs::read_to_string(data("blocks.inp")).unwrap();
    let behaviors = [("LINEAR\n2.0e4", 5e-4), ("TABULAR\n0.0, -1.0e-3\n8.0, 0.0\n12.0, 1.0e-3", 5e-4), ("HARD", 0.0)];
    for (behavior, depth) in behaviors {
        let card = format!("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE={behavior}\n*FRICTION");
        let scratch = tempfile::tempdir().unwrap();
        std::fs::write(scratch.path().join("blocks.inp"), blocks.replacen("*FRICTION", &card, 1)).unwrap();
        let output = zelus(scratch.path(), &["new", "--from", "blocks.inp", "-o", "deck"]);
        assert!(output.status.success(), "{}", said(&output));
        let simulation = solved(&scratch.path().join("deck/ProjectParameters.json"));
        let part = &simulation.model().parts["Structure"];
        let displacement = simulation.field("DISPLACEMENT").unwrap();
        for (at, point) in part.nodes.initial.iter().enumerate().filter(|(_, point)| point[2] > 1.5) {
            let found = displacement[3 * at + 2];
            assert!((found + 0.02 + depth).abs() < 1e-8, "{behavior}: {found} at {point:?}");
        }
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

/// A part of a mesh of Gmsh, written as STL, is a rigid shape without a word about its surface.
#[test]
fn a_surface_becomes_a_rigid_shape() {
    let scratch = start("solids_1_41.msh");
    let folder = scratch.path().join("deck");
    let file = data("solids_1_41.msh");
    let output = zelus(&folder, &["convert", file.to_str().unwrap(), "tool.stl", "--part", "Hexes"]);
    assert!(output.status.success() && said(&output).contains("tool.stl, "), "{}", said(&output));
    let path = folder.join("ProjectParameters.json");
    let tool = json!({"python_module": "rigid_shape_process", "Parameters": {"model_part_name": "Structure.Tool",
        "reference_model_part_name": "Structure.Centre", "shape": {"name": "stl", "file_name": "tool.stl"}, "position": [0.0, 0.0, 9.0]}});
    let list = "\"constraints_process_list\": [";
    let deck = std::fs::read_to_string(&path).unwrap();
    assert!(deck.contains(list));
    std::fs::write(&path, deck.replacen(list, &format!("{list}{tool},"), 1)).unwrap();
    let output = zelus(&folder, &["check", "ProjectParameters.json"]);
    assert!(!said(&output).contains("error["), "{}", said(&output));
    let refused = zelus(&folder, &["convert", file.to_str().unwrap(), "part.inp", "--part", "Hexes"]);
    assert_eq!(refused.status.code(), Some(2), "{}", said(&refused));
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

/// A starter deck of a material that hardly changes its volume, or flows, has elements that do not lock.
#[test]
fn starter_decks_do_not_lock() {
    const MIXED: &str = "SmallDisplacementMixedVolumetricStrainElement2D4N";
    const MEAN_DILATATION: &str = "SmallDisplacementBbarElement2D4N";
    const PLAIN: &str = "SmallDisplacementElement2D4N";
    for (ratio, plastic, element) in
        [(0.4999, "", MIXED), (0.3, "", PLAIN), (0.3, "*PLASTIC\n8,0\n20,0.1\n", MEAN_DILATATION)]
    {
        let scratch = tempfile::tempdir().unwrap();
        let block = format!(
            "*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n*ELEMENT,TYPE=CPE4,ELSET=BLOCK\n1,1,2,3,4\n*NSET,NSET=BOTTOM\n1,2\n\
             *MATERIAL,NAME=M\n*ELASTIC\n1000,{ratio}\n{plastic}*SOLID SECTION,ELSET=BLOCK,MATERIAL=M\n*SURFACE,NAME=TOP\nBLOCK,S3\n\
             *STEP\n*STATIC\n*BOUNDARY\nBOTTOM,1,2\n*DSLOAD\nTOP,P,10\n*END STEP\n"
        );
        std::fs::write(scratch.path().join("block.inp"), block).unwrap();
        let output = zelus(scratch.path(), &["new", "--from", "block.inp", "-o", "deck"]);
        assert!(output.status.success(), "{}", said(&output));
        let mesh = std::fs::read_to_string(scratch.path().join("deck/block.mdpa")).unwrap();
        let block = format!("Begin Elements {element}");
        assert_eq!(
            (mesh.contains(&block), said(&output).contains("locks")),
            (true, element != PLAIN),
            "{}",
            said(&output)
        );
        let output = zelus(scratch.path(), &["run", "deck/ProjectParameters.json"]);
        assert!(output.status.success() && !said(&output).contains("[locking]"), "{}", said(&output));
    }
}

/// Nodes of a box of `cells` hexahedra from `corner`, with ids from `first`, and its elements.
fn box_of_abaqus(first: u32, corner: f64, cells: u32, set: &str) -> String {
    let row = cells + 1;
    let at = |i: u32| f64::from(i) / f64::from(cells);
    let id = |i: u32, j: u32, k: u32| first + i + row * (j + row * k);
    let mut nodes = "*NODE\n".to_owned();
    let mut elements = format!("*ELEMENT, TYPE=C3D8, ELSET={set}\n");
    for (k, j, i) in (0..row).flat_map(|k| (0..row).flat_map(move |j| (0..row).map(move |i| (k, j, i)))) {
        nodes += &format!("{}, {}, {}, {}\n", id(i, j, k), at(i), at(j), corner + at(k));
        if i < cells && j < cells && k < cells {
            let square = |k| [id(i, j, k), id(i + 1, j, k), id(i + 1, j + 1, k), id(i, j + 1, k)];
            let all: Vec<String> = square(k).iter().chain(&square(k + 1)).map(u32::to_string).collect();
            elements += &format!("{}, {}\n", id(i, j, k), all.join(", "));
        }
    }
    nodes + &elements
}

/// Runs the deck that `zelus new` writes of an input file; its folder, the simulation at its end, and the messages of `new`.
fn of_input(text: &str) -> (tempfile::TempDir, Simulation, String) {
    let scratch = tempfile::tempdir().unwrap();
    std::fs::write(scratch.path().join("part.inp"), text).unwrap();
    let output = zelus(scratch.path(), &["new", "--from", "part.inp", "-o", "deck"]);
    assert!(output.status.success(), "{}", said(&output));
    let simulation = solved(&scratch.path().join("deck/ProjectParameters.json"));
    (scratch, simulation, said(&output))
}

/// The sum of a component of the reactions.
fn reaction(simulation: &Simulation, axis: usize) -> f64 {
    let reactions = simulation.field("REACTION").unwrap();
    reactions.iter().skip(axis).step_by(3).filter(|force| **force > 0.0).sum()
}

/// Two cubes of 2³ and 3³ elements, the upper moved up by 0.001: E u A / l = 210e3 · 0.001 / 2 = 105 where they hold together.
fn pulled_cubes(joint: &str) -> String {
    let (low, up) = (box_of_abaqus(1, 0.0, 2, "LOW"), box_of_abaqus(101, 1.0, 3, "UP"));
    format!(
        "{low}{up}*NSET, NSET=BOTTOM, GENERATE\n1, 9\n*NSET, NSET=TOP, GENERATE\n149, 164\n\
         *NSET, NSET=UNDER, GENERATE\n101, 116\n*NSET, NSET=OVER, GENERATE\n19, 27\n\
         *SURFACE, NAME=SM, TYPE=NODE\nOVER\n*SURFACE, NAME=SS, TYPE=NODE\nUNDER\n\
         *MATERIAL, NAME=M\n*ELASTIC\n210000., 0.\n*SOLID SECTION, ELSET=LOW, MATERIAL=M\n*SOLID SECTION, ELSET=UP, MATERIAL=M\n\
         {joint}*BOUNDARY\nBOTTOM, 1, 3\n*STEP\n*STATIC\n*BOUNDARY\nTOP, 1, 2\nTOP, 3, 3, 0.001\n*END STEP\n"
    )
}

#[test]
fn ties_and_tied_contact_of_abaqus_hold() {
    let tied = "*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n1.E7\n*FRICTION\n1., 1.E7\n\
         *CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE\nss, SM\n";
    for joint in ["*TIE, NAME=T\nSS, sm\n", tied] {
        let (_scratch, simulation, said) = of_input(&pulled_cubes(joint));
        assert!(!said.contains("warning"), "{said}");
        let force = reaction(&simulation, 2);
        assert!((force / 105.0 - 1.0).abs() < 1e-9, "{force}");
    }
}

/// A tie beside a contact pair: a third cube below is pressed by the others.
#[test]
fn ties_of_abaqus_stand_beside_contact() {
    for friction in ["", "*FRICTION\n0.3\n"] {
        let joint = format!(
            "{}*NSET, NSET=ALL, GENERATE\n201, 208\n*NSET, NSET=FACE, GENERATE\n205, 208\n*SURFACE, NAME=SF, TYPE=NODE\nFACE\n\
             *SURFACE, NAME=SB, TYPE=NODE\nBOTTOM\n*SOLID SECTION, ELSET=BASE, MATERIAL=M\n\
             *SURFACE INTERACTION, NAME=I\n{friction}*TIE, NAME=T\nSS, SM\n*CONTACT PAIR, INTERACTION=I\nSB, SF\n*BOUNDARY\nALL, 1, 3\n",
            box_of_abaqus(201, -1.0, 1, "BASE")
        );
        let text =
            pulled_cubes(&joint).replace("BOTTOM, 1, 3\n", "BOTTOM, 1, 2\n").replace("3, 3, 0.001", "3, 3, -0.001");
        let (_scratch, simulation, _) = of_input(&text);
        let force = reaction(&simulation, 2);
        assert!((force / 105.0 - 1.0).abs() < 1e-6, "{force}");
    }
}

/// Forces at nodes and no face in the file: 40 in all on a column of stiffness 1000, also where each node has a force of its own.
#[test]
fn forces_at_nodes_alone_make_a_deck() {
    let column = |loads: &str| {
        format!(
            "{}*NSET, NSET=LOW, GENERATE\n1, 9\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n*SOLID SECTION, ELSET=A, MATERIAL=M\n\
             *STEP\n*STATIC\n*BOUNDARY\nLOW, 1, 3\n*CLOAD\n{loads}*END STEP\n",
            box_of_abaqus(1, 0.0, 2, "A")
        )
    };
    let quarters = [(19, 2.5), (20, 5.0), (21, 2.5), (22, 5.0), (23, 10.0), (24, 5.0), (25, 2.5), (26, 5.0), (27, 2.5)];
    let loads: String = quarters.iter().map(|(node, force)| format!("{node}, 3, -{force}\n")).collect();
    let (_scratch, simulation, _) = of_input(&column(&loads));
    assert!((reaction(&simulation, 2) - 40.0).abs() < 1e-9);
    let displacement = simulation.field("DISPLACEMENT").unwrap();
    assert!((displacement[3 * 22 + 2] + 0.04).abs() < 1e-12, "{}", displacement[3 * 22 + 2]);
    // forces that differ from node to node come from a file
    let many: Vec<(u32, f64)> = (5..65).map(|node| (node, f64::from(node) * 0.01)).collect();
    let loads: String = many.iter().map(|(node, force)| format!("{node}, 1, {force}\n{node}, 3, -{force}\n")).collect();
    let text = column(&loads)
        .replace(&box_of_abaqus(1, 0.0, 2, "A"), &box_of_abaqus(1, 0.0, 3, "A"))
        .replace("1, 9\n", "1, 16\n");
    let (scratch, simulation, _) = of_input(&text);
    assert!(scratch.path().join("deck/forces.json").is_file());
    let reactions = simulation.field("REACTION").unwrap();
    let total: f64 = many.iter().map(|(_, force)| force).sum();
    for (axis, wanted) in [-total, 0.0, total].into_iter().enumerate() {
        let sum: f64 = reactions.iter().skip(axis).step_by(3).sum();
        assert!((sum - wanted).abs() < 1e-9, "{axis}: {sum} in place of {wanted}");
    }
}

/// A file as Abaqus/CAE writes it: sets and surfaces of the assembly with `instance=`. Two unit cubes pressed by 0.001 bear 105.
#[test]
fn sets_of_an_assembly_make_a_deck() {
    let text = "*Heading\n*Part, name=Part-1\n*Node\n1,0.,0.,0.\n2,1.,0.,0.\n3,0.,1.,0.\n4,1.,1.,0.\n5,0.,0.,1.\n6,1.,0.,1.\n\
        7,0.,1.,1.\n8,1.,1.,1.\n*Element, type=C3D8\n1, 1, 2, 4, 3, 5, 6, 8, 7\n*Elset, elset=all\n1\n\
        *Solid Section, elset=all, material=M\n,\n*End Part\n*Assembly, name=Assembly\n\
        *Instance, name=Part-1-1, part=Part-1\n*End Instance\n*Instance, name=Part-1-2, part=Part-1\n0.,0.,1.\n*End Instance\n\
        *Nset, nset=Set-1, instance=Part-1-1\n 1, 2, 3, 4\n*Elset, elset=Set-1, instance=Part-1-1\n 1\n\
        *Nset, nset=Set-2, instance=Part-1-2\n 5,6,7,8\n*Elset, elset=_Surf-1_S2, internal, instance=Part-1-1\n 1\n\
        *Surface, type=ELEMENT, name=Surf-1\n_Surf-1_S2, S2\n*Elset, elset=_Surf-2_S1, internal, instance=Part-1-2\n 1\n\
        *Surface, type=ELEMENT, name=Surf-2\n_Surf-2_S1, S1\n*End Assembly\n*Material, name=M\n*Elastic\n210000., 0.\n\
        *Surface Interaction, name=I\n1.,\n*Friction\n0.3,\n*Surface Behavior, pressure-overclosure=HARD\n\
        *Contact Pair, interaction=I, type=SURFACE TO SURFACE\nSurf-2, Surf-1\n*Boundary\nSet-1, ENCASTRE\n\
        *Step, name=Step-1, nlgeom=NO\n*Static\n0.1,1.,1e-05,1.\n*Boundary\nSet-2, 1, 2\nSet-2, 3, 3, -0.001\n*End Step\n";
    let (scratch, simulation, said) = of_input(text);
    assert!(said.contains("contact: slave Surf-2, master Surf-1") && !said.contains("warning"), "{said}");
    let force = reaction(&simulation, 2);
    assert!((force / 105.0 - 1.0).abs() < 1e-6, "{force}");
    let mesh = std::fs::read_to_string(scratch.path().join("deck/part.mdpa")).unwrap();
    assert!(!mesh.contains("TotalLagrangian"));
    let large = zelus(scratch.path(), &["new", "--from", "part.inp", "-o", "large"]);
    assert!(large.status.success());
    std::fs::write(scratch.path().join("part.inp"), text.replace("nlgeom=NO", "nlgeom=YES")).unwrap();
    let large = zelus(scratch.path(), &["new", "--from", "part.inp", "-o", "nlgeom"]);
    assert!(large.status.success());
    let mesh = std::fs::read_to_string(scratch.path().join("nlgeom/part.mdpa")).unwrap();
    assert!(mesh.contains("TotalLagrangianElement3D8N"));
}

/// A bar of length and area 1 and stiffness 1000 under two forces, one by an amplitude that falls back to 0.
#[test]
fn amplitudes_and_steps_of_abaqus_give_histories() {
    let bar = |steps: &str| {
        format!(
            "{}*NSET, NSET=LOW, GENERATE\n1, 4\n*NSET, NSET=TOP, GENERATE\n5, 8\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n\
             *SOLID SECTION, ELSET=A, MATERIAL=M\n*AMPLITUDE, NAME=RAMP\n0.,0.,0.5,1.,1.,0.\n*AMPLITUDE, NAME=SAW\n\
             0.,0., .1,1., .2,0., .3,1.\n.4,0., .5,1., .6,0., .7,1.\n.8,0.,1.,1.\n*BOUNDARY\nLOW, 1, 3\n{steps}",
            box_of_abaqus(1, 0.0, 1, "A")
        )
    };
    let up = |simulation: &Simulation| simulation.field("DISPLACEMENT").unwrap()[3 * 7 + 2];
    let along = |simulation: &Simulation| -> f64 { simulation.field("REACTION").unwrap().iter().step_by(3).sum() };
    for (steps, wanted, shear) in [
        ("*STEP\n*STATIC\n*CLOAD, AMPLITUDE=RAMP\nTOP, 3, 10.\n*END STEP\n", 0.0, 0.0),
        ("*STEP\n*STATIC\n*CLOAD, AMPLITUDE=RAMP\nTOP, 1, 10.\n*CLOAD\nTOP, 3, 10.\n*END STEP\n", 0.04, 0.0),
        ("*STEP\n*STATIC\n*CLOAD, AMPLITUDE=SAW\nTOP, 3, 10.\n*END STEP\n", 0.04, 0.0),
        ("*STEP\n*STATIC\n0.1, 0.5\n*CLOAD, AMPLITUDE=RAMP\nTOP, 3, 10.\n*END STEP\n", 0.04, 0.0),
        ("*STEP\n*STATIC\n*CLOAD\nTOP, 3, 10.\nTOP, 3, 5.\nTOP, 1, 1.\n*END STEP\n", 0.06, -4.0),
        (
            "*STEP\n*STATIC\n*CLOAD\nTOP, 3, 10.\n*END STEP\n*STEP\n*STATIC\n*CLOAD\nTOP, 3, -5.\n*END STEP\n",
            -0.02,
            0.0,
        ),
        ("*STEP\n*STATIC\n*DLOAD\nA, P2, -20.\n*DLOAD\nA, P2, -30.\n*END STEP\n", 0.05, 0.0),
        ("*STEP\n*STATIC\n1., 4.\n*BOUNDARY, TYPE=VELOCITY\nTOP, 3, 3, 0.01\n*END STEP\n", 0.04, 0.0),
        (
            "*STEP\n*STATIC\n*BOUNDARY\nTOP, 3, 3, 0.1\n*END STEP\n*STEP\n*STATIC\n*BOUNDARY, OP=NEW\nLOW, 1, 3\n*END STEP\n",
            0.0,
            0.0,
        ),
    ] {
        let (_scratch, simulation, said) = of_input(&bar(steps));
        assert!(!said.contains("warning"), "{said}");
        let found = up(&simulation);
        // shear bends the bar, so node 8 is no measure there
        assert!(shear != 0.0 || (found - wanted).abs() < 1e-9, "{steps}: {found} in place of {wanted}");
        assert!((along(&simulation) - shear).abs() < 1e-9, "{steps}: {}", along(&simulation));
    }
}

/// A block of 2³ elements of length 1 along z, held below, with stiffness 1000 and no contraction, and these cards.
fn block_of_abaqus(material: &str, section: &str, cards: &str) -> String {
    format!(
        "{}*NSET, NSET=LOW, GENERATE\n1, 9\n*NSET, NSET=TOP, GENERATE\n19, 27\n*NSET, NSET=ALL, GENERATE\n1, 27\n\
         *SURFACE, NAME=FACE, TYPE=NODE\nTOP\n*MATERIAL, NAME=M\n{material}*SOLID SECTION, ELSET=A, MATERIAL=M{section}\n{cards}",
        box_of_abaqus(1, 0.0, 2, "A")
    )
}

const PLAIN: &str = "*ELASTIC\n1000., 0.\n";

fn displacement(simulation: &Simulation, point: [f64; 3]) -> [f64; 3] {
    let nodes = &simulation.model().parts["Structure"].nodes.initial;
    let at = nodes.iter().position(|own| own.iter().zip(point).all(|(a, b)| (a - b).abs() < 1e-9)).unwrap();
    let all = simulation.field("DISPLACEMENT").unwrap();
    [0, 1, 2].map(|i| all[3 * at + i])
}

/// Loads at reference nodes: the face moves by F l / (E A) = 0.02 as a whole, and by a rotation that is prescribed.
#[test]
fn couplings_of_abaqus_pass_loads_and_motions() {
    let below = "*BOUNDARY\nLOW, 1, 3\n*NODE, NSET=REF\n100, 0.5, 0.5, 1.\n101, 0.5, 0.5, 1.\n";
    let pulled = "*STEP\n*STATIC\n*CLOAD\n100, 3, 20.\n*END STEP\n";
    for coupling in [
        "*COUPLING, REF NODE=100, SURFACE=FACE, CONSTRAINT NAME=C\n*KINEMATIC\n1, 3\n",
        "*COUPLING, REF NODE=100, SURFACE=FACE, CONSTRAINT NAME=C\n*KINEMATIC\n3, 3\n",
        "*COUPLING, REF NODE=100, SURFACE=FACE, CONSTRAINT NAME=C\n*DISTRIBUTING\n1, 3\n",
        "*RIGID BODY, NSET=TOP, REF NODE=100, ROT NODE=101\n",
    ] {
        // a small moment about each axis gives the criterion of rotations its unit
        let steps = pulled.replace(
            "*CLOAD\n",
            if coupling.contains("ROT") { "*CLOAD\n101, 1, 1e-6\n" } else { "*CLOAD\n100, 4, 1e-6\n" },
        );
        let (_scratch, simulation, said) = of_input(&block_of_abaqus(PLAIN, "", &format!("{below}{coupling}{steps}")));
        assert!(!said.contains("warning"), "{said}");
        let up = displacement(&simulation, [0.5, 0.5, 1.0])[2];
        assert!((up - 0.02).abs() < 1e-6, "{coupling}: {up}");
    }
    // a rotation of 0.01 about z: nodes move by the arm times it
    let turned = "*RIGID BODY, NSET=TOP, REF NODE=100, ROT NODE=101\n*STEP\n*STATIC\n*BOUNDARY\n100, 1, 3\n101, 1, 2\n101, 3, 3, 0.01\n*END STEP\n";
    let (_scratch, simulation, _) = of_input(&block_of_abaqus(PLAIN, "", &format!("{below}{turned}")));
    let [x, y, z] = displacement(&simulation, [1.0, 1.0, 1.0]);
    assert!((x + 0.005).abs() < 1e-9 && (y - 0.005).abs() < 1e-9 && z.abs() < 1e-9, "{x} {y} {z}");
}

/// Equations: the top moves as one node, which bears the whole force; a slanted roller mixes directions.
#[test]
fn equations_of_abaqus_relate_unknowns() {
    let alone = "*BOUNDARY\nLOW, 1, 3\n*NSET, NSET=REST\n19,20,21,22,24,25,26,27\n*EQUATION\n2\nREST, 3, 1., 23, 3, -1.\n\
        *STEP\n*STATIC\n*CLOAD\n23, 3, 20.\n*END STEP\n";
    let (scratch, simulation, said) = of_input(&block_of_abaqus(PLAIN, "", alone));
    assert!(!said.contains("warning"), "{said}");
    for corner in [[0.0, 0.0, 1.0], [0.5, 0.5, 1.0]] {
        assert!((displacement(&simulation, corner)[2] - 0.02).abs() < 1e-9);
    }
    let mesh = std::fs::read_to_string(scratch.path().join("deck/part.mdpa")).unwrap();
    assert!(mesh.contains("Begin Constraints LinearMasterSlaveConstraint DISPLACEMENT_Z"));
    // 3 u_x + 4 u_z = 0 at all nodes of the top, which move by u_x = 0.04: also where a second equation uses the same unknowns
    let slanted = "*BOUNDARY\nLOW, 1, 3\n*EQUATION\n2\nTOP, 3, 4., TOP, 1, 3.\n3\n23, 2, 1., 23, 3, 1., 23, 1, 0.75\n\
        *STEP\n*STATIC\n*BOUNDARY\nTOP, 1, 1, 0.04\n*END STEP\n";
    let (_scratch, simulation, said) = of_input(&block_of_abaqus(PLAIN, "", slanted));
    assert!(!said.contains("warning"), "{said}");
    let [x, y, z] = displacement(&simulation, [0.5, 0.5, 1.0]);
    assert!((x - 0.04).abs() < 1e-12 && (z + 0.03).abs() < 1e-12 && y.abs() < 1e-12, "{x} {y} {z}");
}

/// A column that is tightened by 50 at its middle between two fixed ends bears 50 everywhere.
#[test]
fn pre_tension_sections_of_abaqus_tighten() {
    let cards = |load: &str| {
        format!(
            "*ELSET, ELSET=HALF\n1, 2, 4, 5\n*SURFACE, NAME=CUT\nHALF, S2\n*NODE\n100, 0., 0., 0.\n\
             *PRE-TENSION SECTION, SURFACE=CUT, NODE=100\n0., 0., 1.\n*BOUNDARY\nLOW, 1, 3\nTOP, 1, 3\n*STEP\n*STATIC\n{load}*END STEP\n"
        )
    };
    // locked at 0.05 of a length of 1: E A u / l = 50 as well
    for load in ["*CLOAD\n100, 1, 50.\n", "*BOUNDARY\n100, 1, 1, 0.05\n"] {
        let (_scratch, simulation, said) = of_input(&block_of_abaqus(PLAIN, "", &cards(load)));
        assert!(!said.contains("warning"), "{said}");
        // at the upper end alone: the reference node of the section has a reaction of its own
        let nodes = &simulation.model().parts["Structure"].nodes.initial;
        let reactions = simulation.field("REACTION").unwrap();
        let above = nodes.iter().enumerate().filter(|(_, point)| point[2] > 0.99);
        let force: f64 = above.map(|(at, _)| reactions[3 * at + 2]).sum();
        assert!((force / 50.0 - 1.0).abs() < 1e-6, "{load}: {force}");
    }
}

/// Orthotropic moduli along turned axes: E₂ = 2000 lies along z.
#[test]
fn orientations_of_abaqus_turn_the_material() {
    let material = "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n1000., 2000., 4000., 0., 0., 0., 500., 500.,\n500., 0.\n";
    let cards =
        "*BOUNDARY\nLOW, 1, 3\n*STEP\n*STATIC\n*DLOAD\nA, GRAV, 0., 0., 0., 1.\n*DSLOAD\nFACE, P, -20.\n*END STEP\n";
    for (axes, along) in
        [("1., 0., 0., 0., 0., 1.", 2000.0), ("0., 0., 1., 0., 1., 0.", 1000.0), ("0., 1., 0., 1., 0., 0.", 4000.0)]
    {
        let turned = format!("*ORIENTATION, NAME=O, SYSTEM=RECTANGULAR\n{axes}\n");
        let text = block_of_abaqus(material, ", ORIENTATION=O", cards).replace("*SOLID", &format!("{turned}*SOLID"));
        let (_scratch, simulation, said) = of_input(&text);
        assert!(!said.contains("warning"), "{said}");
        let up = displacement(&simulation, [0.5, 0.5, 1.0])[2];
        assert!((up - 20.0 / along).abs() < 1e-9, "{axes}: {up}");
    }
}

/// ANALYTIC: a bar pulled to λ = 1.5 carries 2 (λ − λ⁻²)(C₁₀ + C₀₁/λ) by initial area where it keeps its volume; κ = 1000 μ is 1e-3 away.
/// The energies of one material by four cards agree.
#[test]
fn energies_of_abaqus_are_those_of_rubber() {
    let cards = "*BOUNDARY\nLOW, 3, 3\n1, 1, 2\n3, 2, 2\n*STEP, NLGEOM\n*STATIC\n0.25, 1.\n*BOUNDARY\nTOP, 3, 3, 0.5\n*END STEP\n";
    let l: f64 = 1.5;
    let force_of = |material: &str| {
        let (_scratch, simulation, said) = of_input(&block_of_abaqus(material, "", cards));
        assert!(!said.contains("warning"), "{material}: {said}");
        reaction(&simulation, 2)
    };
    let expected = 2.0 * (l - l.powi(-2)) * (0.4 + 0.1 / l);
    for material in [
        "*HYPERELASTIC, MOONEY-RIVLIN\n0.4, 0.1, 0.002\n",
        "*HYPERELASTIC, N=2\n0.4, 0.1, 0., 0., 0., 0.002, 0.\n",
        "*HYPERELASTIC, OGDEN, N=2\n0.8, 2., 0.2, -2., 0.002, 0.\n",
        "*HYPERELASTIC, MOONEY-RIVLIN\n0.4, 0.1, 0.\n",
    ] {
        let force = force_of(material);
        assert!((force / expected - 1.0).abs() < 1e-3, "{material}: {force} instead of {expected}");
    }
    let x = l * l + 2.0 / l - 3.0;
    let expected = 2.0 * (l - l.powi(-2)) * (0.4 + 0.2 * x + 0.03 * x * x);
    let force = force_of("*HYPERELASTIC, YEOH\n0.4, 0.1, 0.01, 0.002\n");
    assert!((force / expected - 1.0).abs() < 1e-3, "{force} instead of {expected}");
}

/// A bar that is heated by 50 over its initial 20 degrees between fixed ends: E α ΔT = 1000 · 1e-4 · 50 = 5.
#[test]
fn temperatures_of_abaqus_expand() {
    let cards = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 20.\n*BOUNDARY\nLOW, 1, 3\nTOP, 1, 3\n*STEP\n*STATIC\n*TEMPERATURE\nALL, 70.\n*END STEP\n";
    let material = "*ELASTIC\n2000., 0., 20.\n1000., 0., 70.\n*EXPANSION, ZERO=20.\n1.E-4\n";
    let (_scratch, simulation, said) = of_input(&block_of_abaqus(material, "", cards));
    assert!(!said.contains("warning"), "{said}");
    let force = reaction(&simulation, 2);
    assert!((force - 5.0).abs() < 1e-9, "{force}");
}

/// A bar that is stretched to a plastic strain of 0.05 on a curve from 100 to 200 over 0.1: stress 150.
#[test]
fn yield_curves_of_abaqus_harden() {
    let material = "*ELASTIC\n100000., 0.3\n*PLASTIC\n100., 0.\n200., 0.1\n";
    let cards = "*BOUNDARY\nLOW, 3, 3\n1, 1, 2\n3, 2, 2\n*STEP\n*STATIC\n*BOUNDARY\nTOP, 3, 3, 0.0515\n*END STEP\n";
    let (_scratch, simulation, said) = of_input(&block_of_abaqus(material, "", cards));
    assert!(!said.contains("warning"), "{said}");
    let force = reaction(&simulation, 2);
    assert!((force - 150.0).abs() < 1e-4, "{force}");
}

/// A bar that turns about an end: σ = ω² ρ l² / 2 at the axis; and its weight, which adds up.
#[test]
fn centrifugal_loads_and_gravity_of_abaqus_add_up() {
    let material = "*ELASTIC\n1000., 0.\n*DENSITY\n2.\n";
    let cards = "*BOUNDARY\nLOW, 1, 3\n*STEP\n*STATIC\n*DLOAD\nA, CENTRIF, 9., 0.5, 0.5, 0., 1., 0., 0.\nA, GRAV, 10., 0., 0., -1.\n*END STEP\n";
    let (_scratch, simulation, said) = of_input(&block_of_abaqus(material, "", cards));
    assert!(!said.contains("warning"), "{said}");
    let sum: f64 = simulation.field("REACTION").unwrap().iter().skip(2).step_by(3).sum();
    assert!((sum + 9.0 * 2.0 / 2.0 - 20.0).abs() < 1e-9, "{sum}");
}

/// Two plates of thickness 0.5 and 2, pulled by 100 per area: both strain by 0.1, and the support bears 100 (0.5 + 2).
#[test]
fn pressures_on_plates_of_abaqus_act_on_their_thickness() {
    let text = "*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n5,1,2\n6,0,2\n*ELEMENT,TYPE=CPS4,ELSET=THIN\n1,1,2,3,4\n\
        *ELEMENT,TYPE=CPS4,ELSET=THICK\n2,4,3,5,6\n*NSET,NSET=LEFT\n1,4,6\n*MATERIAL,NAME=M\n*ELASTIC\n1000.,0.\n\
        *SOLID SECTION,ELSET=THIN,MATERIAL=M\n0.5\n*SOLID SECTION,ELSET=THICK,MATERIAL=M\n2.\n*BOUNDARY\nLEFT,1\n1,2\n\
        *STEP\n*STATIC\n*DLOAD\nTHIN,P2,-100.\nTHICK,P2,-100.\n*END STEP\n";
    let (_scratch, simulation, said) = of_input(text);
    assert!(!said.contains("warning"), "{said}");
    for y in [0.0, 1.0, 2.0] {
        assert!((displacement(&simulation, [1.0, y, 0.0])[0] - 0.1).abs() < 1e-9);
    }
    let sum: f64 = simulation.field("REACTION").unwrap().iter().step_by(3).sum();
    assert!((sum + 250.0).abs() < 1e-9, "{sum}");
}

/// Supports, loads, friction and materials by options: an aluminium block of 1 mm under 700 N along z and 100 MPa, E = 70000.
#[test]
fn options_state_supports_loads_friction_and_materials() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let text = block_of_abaqus("", "", "").replace("*MATERIAL, NAME=M\n*SOLID SECTION, ELSET=A, MATERIAL=M\n", "");
    std::fs::write(folder.join("block.inp"), text).unwrap();
    let new = |arguments: &[&str]| zelus(folder, &[&["new", "--from", "block.inp"], arguments].concat());
    let options = ["--fix", "LOW=z", "--fix", "ALL=xy", "--material", "aluminium", "--friction", "0.2", "-o", "deck"];
    let output = new(&[&options[..], &["--load", "FACE=0.7kN,-z", "--load", "FACE=100MPa"]].concat());
    assert!(output.status.success(), "{}", said(&output));
    let simulation = solved(&folder.join("deck/ProjectParameters.json"));
    // held across: u = σ (1 + ν) (1 − 2 ν) / (1 − ν) l / E with σ = 800, ν = 0.3
    let wanted = -800.0 * 1.3 * 0.4 / 0.7 / 70_000.0;
    let found = displacement(&simulation, [0.5, 0.5, 1.0])[2];
    assert!((found / wanted - 1.0).abs() < 1e-9, "{found} {wanted}");
    assert!((reaction(&simulation, 2) - 800.0).abs() < 1e-6);
    let materials = std::fs::read_to_string(folder.join("deck/StructuralMaterials.json")).unwrap();
    assert!(materials.contains("aluminium (EN 1999-1-1, 3.2.5)") && materials.contains("2.7e-9"), "{materials}");
    for (arguments, fact) in [
        (["--fix", "LOV"], "the mesh has no part \"LOV\""),
        (["--fix", "LOW=w"], "are no directions"),
        (["--load", "FACE"], "has no value"),
        (["--load", "FACE=5"], "a force has a direction"),
        (["--load", "FACE=5N,up"], "is no direction"),
        (["--load", "FACE=5MPa,z"], "along the normal"),
        (["--load", "LOW=5MPa"], "has no faces"),
        (["--material", "stele"], "did you mean \"steel\""),
        (["--material", "LOW=steel"], "has no elements"),
        (["--friction", "nan"], "is no coefficient"),
    ] {
        let output = new(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", said(&output));
        assert!(said(&output).contains(fact), "{arguments:?}: {}", said(&output));
    }
}

/// A coefficient of friction of the command line is that of all pairs that are found, and materials of bodies differ.
#[test]
fn options_reach_pairs_that_are_found() {
    let scratch = tempfile::tempdir().unwrap();
    let mesh = data("solids_1_41.msh");
    let arguments =
        ["new", "--from", mesh.to_str().unwrap(), "-o", "deck", "--friction", "0.25", "--material", "Tets=titanium"];
    let output = zelus(scratch.path(), &arguments);
    assert!(output.status.success(), "{}", said(&output));
    let deck = std::fs::read_to_string(scratch.path().join("deck/ProjectParameters.json")).unwrap();
    assert!(deck.contains("\"contact_type\": \"Frictional\"") && deck.contains("{\"0\": 0.25, \"1\": 0.25}"), "{deck}");
    let materials = std::fs::read_to_string(scratch.path().join("deck/StructuralMaterials.json")).unwrap();
    assert!(materials.contains("110000.0") && materials.contains("210000.0"), "{materials}");
    let output = zelus(&scratch.path().join("deck"), &["check", "ProjectParameters.json"]);
    assert!(output.status.success(), "{}", said(&output));
}

/// The lug of the examples at 1000 N by every formulation: the same motion, and but for Nitsche's method, whose pressure is that of the
/// elements, the same pressure.
#[test]
fn formulations_by_name_run() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    std::fs::copy(root().join("examples/lug/lug.msh"), folder.join("lug.msh")).unwrap();
    let options = ["new", "--from", "lug.msh", "--fix", "Bottom", "--fix", "Symmetry=x", "--load", "PinCore=1000N,y"];
    let new = |name: &str, more: &[&str]| {
        let own = ["--formulation", name, "-o", name];
        zelus(folder, &[&options[..], &own, more].concat())
    };
    let mut wanted: Option<[f64; 2]> = None;
    for name in ["alm", "penalty", "uzawa", "perturbed_lagrangian", "nitsche", "mpc"] {
        let output = new(name, &[]);
        assert!(output.status.success(), "{}", said(&output));
        let deck = format!("{name}/ProjectParameters.json");
        let output = zelus(folder, &["run", &deck, "-q", "--report", "run.json"]);
        assert!(output.status.success(), "{name}: {}", said(&output));
        let report = read_json(&folder.join("run.json")).unwrap();
        let found = ["DISPLACEMENT", "CONTACT_PRESSURE"].map(|key| report["largest"][key].as_f64().unwrap());
        let [motion, pressure] = *wanted.get_or_insert(found);
        // 0.3 % of pressure for the penetration of penalties, 2 % of motion for the consistent traction of Nitsche's method
        assert!((found[0] / motion - 1.0).abs() < 0.02, "{name}: {found:?}");
        assert!(name == "nitsche" || (found[1] / pressure - 1.0).abs() < 3e-3, "{name}: {found:?} {wanted:?}");
    }
    for (name, more, fact) in [
        ("uzawa", &["--friction", "0.2"][..], "it has no friction"),
        ("penaly", &[], "did you mean \"penalty\""),
        ("alm", &["--slave", "Hoole"], "surfaces: Hole, PinFace"),
    ] {
        std::fs::remove_dir_all(folder.join(name)).ok();
        let output = new(name, more);
        assert!(output.status.code() == Some(2) && said(&output).contains(fact), "{name}: {}", said(&output));
    }
}

/// A short row of squares on a long one: the order of the sides is that of the materials, else of the meshes, else of the areas, so that
/// it is the same for coarse and fine meshes alike.
#[test]
fn the_softer_finer_or_smaller_side_is_the_slave() {
    let rows = |lower: u32, upper: u32| {
        let mut text = String::from("*NODE\n");
        let (mut cells, mut first) = (String::new(), 1);
        for (name, length, count, y) in [("LOWER", 4.0, lower, -1.0), ("UPPER", 2.0, upper, 0.0)] {
            cells += &format!("*ELEMENT, TYPE=CPE4, ELSET={name}\n");
            for i in 0..=count {
                for j in 0..2_u32 {
                    let (x, y) = (length * f64::from(i) / f64::from(count), y + f64::from(j));
                    text += &format!("{}, {x:?}, {y:?}\n", first + 2 * i + j);
                }
            }
            for i in 0..count {
                let at = first + 2 * i;
                cells += &format!("{at}, {at}, {}, {}, {}\n", at + 2, at + 3, at + 1);
            }
            first += 2 * count + 2;
        }
        format!("{text}{cells}*SURFACE, NAME=LOWFACE\nLOWER, S3\n*SURFACE, NAME=UPFACE\nUPPER, S1\n")
    };
    for (counts, options, slave, reason) in [
        ((4, 2), &[][..], "UPFACE", "smaller, of like meshes"),
        ((16, 8), &[], "UPFACE", "smaller, of like meshes"),
        ((5, 2), &[], "UPFACE", "smaller, of like meshes"),
        ((16, 2), &[], "LOWFACE", "finer"),
        ((4, 8), &["--material", "LOWER=aluminium"], "LOWFACE", "softer"),
        ((16, 2), &["--material", "UPPER=aluminium"], "UPFACE", "softer"),
        ((4, 2), &["--slave", "LOWFACE"], "LOWFACE", "found by proximity"),
    ] {
        let scratch = tempfile::tempdir().unwrap();
        std::fs::write(scratch.path().join("rows.inp"), rows(counts.0, counts.1)).unwrap();
        let output = zelus(scratch.path(), &[&["new", "--from", "rows.inp", "-o", "deck"], options].concat());
        let line = said(&output).lines().find(|line| line.starts_with("contact: ")).unwrap_or_default().to_owned();
        assert!(line.contains(&format!("slave {slave}, ")) && line.contains(reason), "{counts:?} {options:?}: {line}");
        let deck = std::fs::read_to_string(scratch.path().join("deck/ProjectParameters.json")).unwrap();
        assert!(deck.contains(&format!("\"assume_master_slave\": {{\"0\": [\"{slave}\"]}}")), "{deck}");
    }
}

/// A quarter of a ring of one element, under pressure inside, as a cyclic sector: the radial displacement is the same on both sides, and
/// forces balance as in the sector with planes of symmetry.
#[test]
fn cyclic_sectors_of_abaqus_repeat() {
    let ring = |cards: &str| {
        let mut nodes = "*NODE\n".to_owned();
        for (k, z) in [0.0, 1.0].into_iter().enumerate() {
            for i in 0..5_u32 {
                let (sine, cosine) = (f64::from(i) * std::f64::consts::FRAC_PI_2 / 4.0).sin_cos();
                for (j, r) in [1.0, 2.0].into_iter().enumerate() {
                    nodes +=
                        &format!("{}, {:?}, {:?}, {z}\n", 1 + j as u32 + 2 * i + 10 * k as u32, r * cosine, r * sine);
                }
            }
        }
        let element = |i: u32| {
            let [a, b, c, d] = [1, 2, 4, 3].map(|node| node + 2 * i);
            format!("{}, {a}, {b}, {c}, {d}, {}, {}, {}, {}\n", i + 1, a + 10, b + 10, c + 10, d + 10)
        };
        let elements: String = (0..4).map(element).collect();
        format!(
            "{nodes}*ELEMENT, TYPE=C3D8, ELSET=A\n{elements}*NSET, NSET=ALL, GENERATE\n1, 20\n*NSET, NSET=X\n1, 2, 11, 12\n\
             *NSET, NSET=Y\n9, 10, 19, 20\n*SURFACE, NAME=SX, TYPE=NODE\nX\n*SURFACE, NAME=SY, TYPE=NODE\nY\n*MATERIAL, NAME=M\n\
             {PLAIN}*SOLID SECTION, ELSET=A, MATERIAL=M\n*BOUNDARY\nALL, 3, 3\n{cards}*STEP\n*STATIC\n*DLOAD\nA, P6, 10.\n*END STEP\n"
        )
    };
    let planes = "*BOUNDARY\nX, 2, 2\nY, 1, 1\n";
    let (_scratch, wanted, _) = of_input(&ring(planes));
    for sides in ["SY, SX", "SX, SY"] {
        // rotations about the axis are held at one node
        let sector = format!(
            "*TIE, NAME=T, CYCLIC SYMMETRY\n{sides}\n*CYCLIC SYMMETRY MODEL, N=4, TIE=T\n0., 0., 0., 0., 0., 1.\n*BOUNDARY\n5, 1, 1, 0.\n"
        );
        let sector = sector.replace("5, 1, 1, 0.\n", "").replace("*BOUNDARY\n", "");
        let held = format!("{sector}*TRANSFORM, NSET=ONE, TYPE=C\n0., 0., 0., 0., 0., 1.\n*BOUNDARY\nONE, 2, 2\n");
        let text = ring(&held).replace("*SURFACE, NAME=SX", "*NSET, NSET=ONE\n5\n*SURFACE, NAME=SX");
        let (_scratch, simulation, said) = of_input(&text);
        assert!(!said.contains("warning"), "{said}");
        let radial = |simulation: &Simulation, point: [f64; 3]| {
            let [x, y, _] = displacement(simulation, point);
            (x * point[0] + y * point[1]) / point[0].hypot(point[1])
        };
        let (root, inner) = (0.5_f64.sqrt(), [1.0, 0.0, 0.0]);
        for point in [inner, [0.0, 2.0, 1.0], [root, root, 0.0]] {
            let (found, exact) = (radial(&simulation, point), radial(&wanted, point));
            assert!((found / exact - 1.0).abs() < 1e-9, "{sides} {point:?}: {found} {exact}");
        }
    }
}

/// Springs and masses of CalculiX: displacements by `ccx` 2.20 on this file, without and with NLGEOM.
#[test]
fn springs_and_masses_of_calculix_act() {
    let text = "*NODE, NSET=ALL\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n9,0,0,3\n10,3,3,1\n\
        *ELEMENT, TYPE=C3D8, ELSET=A\n1,1,2,3,4,5,6,7,8\n*ELEMENT, TYPE=SPRING1, ELSET=G\n2,7\n\
        *ELEMENT, TYPE=SPRING2, ELSET=B\n3,5,9\n*ELEMENT, TYPE=SPRINGA, ELSET=X\n4,7,10\n*ELEMENT, TYPE=MASS, ELSET=MA\n5,8\n\
        *ELSET, ELSET=EVERY\nA, G, 5\n*MATERIAL,NAME=M\n*ELASTIC\n1000.,0.\n*SOLID SECTION, ELSET=A, MATERIAL=M\n\
        *SPRING, ELSET=G\n1\n\n100.\n*SPRING, ELSET=B\n3,3\n200.\n*SPRING, ELSET=X\n\n300.\n*MASS, ELSET=MA\n2.\n\
        *BOUNDARY\n1,1,3\n2,2,3\n3,3,3\n4,3,3\n4,1,1\n9,1,3\n10,1,3\n*STEP\n*STATIC\n*CLOAD\n6,1,10.\n7,2,5.\n\
        *DLOAD\nMA,GRAV,9.81,0,0,-1\n*END STEP\n";
    // EXTERNAL: ccx 2.20, which ends its iteration at a residual of 0.5 %; without it the two agree to its 7 digits
    let linear = [
        ([0.0, 0.0, 1.0], [3.066800e-2, 8.400899e-3, 2.134515e-2]),
        ([1.0, 1.0, 1.0], [-4.626451e-2, 6.707162e-2, 1.960120e-3]),
        ([0.0, 1.0, 1.0], [-3.418104e-2, 1.312159e-2, -1.186578e-1]),
    ];
    let large = [
        ([0.0, 0.0, 1.0], [1.924257e-2, 2.403134e-2, 2.185885e-2]),
        ([1.0, 1.0, 1.0], [-4.746421e-2, 6.761127e-2, -7.702620e-4]),
        ([0.0, 1.0, 1.0], [-3.028908e-2, 2.019632e-2, -1.375890e-1]),
    ];
    for (text, wanted) in [(text.to_owned(), linear), (text.replace("*STEP", "*STEP, NLGEOM"), large)] {
        let (_scratch, simulation, said) = of_input(&text);
        assert!(!said.contains("warning"), "{said}");
        for (point, wanted) in wanted {
            let found = displacement(&simulation, point);
            let apart = found.iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(apart < 1e-5, "{point:?}: {found:?} {wanted:?}");
        }
    }
}

/// Springs that cannot be, and a mass and inertia on a rigid body: named with their lines, or kept.
#[test]
fn springs_that_cannot_be_are_named() {
    let below = "*BOUNDARY\nLOW, 1, 3\n*NODE, NSET=REF\n100, 0.5, 0.5, 1.\n*RIGID BODY, NSET=TOP, REF NODE=100\n\
        *ELEMENT, TYPE=MASS, ELSET=W\n901, 100\n*ELEMENT, TYPE=ROTARYI, ELSET=R\n902, 100\n*MASS, ELSET=W\n3.\n\
        *ROTARY INERTIA, ELSET=R\n1., 2., 3., 0.1\n*ELEMENT, TYPE=SPRING1, ELSET=G\n903, 1\n904, 2\n\
        *SPRING, ELSET=G, NONLINEAR\n1\n0., 0.\n1., 1.\n*ELEMENT, TYPE=SPRING2, ELSET=H\n905, 1, 2\n*SPRING, ELSET=H\n1, 2\n5.\n\
        *ELEMENT, TYPE=SPRINGA, ELSET=N\n906, 1, 2\n\
        *STEP\n*STATIC\n*DLOAD\nW, GRAV, 10., 0., 0., -1.\n*END STEP\n";
    let (scratch, simulation, said) = of_input(&block_of_abaqus(PLAIN, "", below));
    for fact in [
        "*SPRING, NONLINEAR: springs here are linear",
        "springs between different directions",
        "elements SPRINGA without constants are left out",
    ] {
        assert!(said.lines().any(|line| line.contains(fact) && line.contains("part.inp:")), "{fact}: {said}");
    }
    let deck = std::fs::read_to_string(scratch.path().join("deck/ProjectParameters.json")).unwrap();
    assert!(deck.contains("\"mass\": 3.0") && deck.contains("[[1.0, 0.1, 0.0], [0.1, 2.0, 0.0], [0.0, 0.0, 3.0]]"));
    // ANALYTIC: the weight of 30 on a column of stiffness 1000
    let down = displacement(&simulation, [0.5, 0.5, 1.0])[2];
    assert!((down + 0.03).abs() < 1e-6, "{down}");
}

/// Surfaces that do not separate: a pull of 0.001 is carried, 210e3 · 0.001 / 2 = 105, and sliding is free; with ROUGH they are tied.
#[test]
fn surfaces_of_abaqus_without_separation_carry_tension() {
    let joint =
        "*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, NO SEPARATION\n*CONTACT PAIR, INTERACTION=I\nSS, SM\n";
    let slid = pulled_cubes(joint).replace("TOP, 1, 2\n", "TOP, 2\nTOP, 1, 1, 0.001\n");
    let (_scratch, simulation, said) = of_input(&slid);
    assert!(!said.contains("warning"), "{said}");
    let (pull, shear) = (reaction(&simulation, 2), reaction(&simulation, 0));
    // ANALYTIC: 0.1 % of the face slides off the other
    assert!((pull / 105.0 - 1.0).abs() < 2e-3, "{pull}");
    assert!(shear < 1e-3 * pull, "{shear}");
    let rough = joint.replace("*CONTACT PAIR", "*FRICTION, ROUGH\n*CONTACT PAIR");
    let (_scratch, simulation, said) = of_input(&pulled_cubes(&rough));
    assert!(said.contains("tied: slave SS"), "{said}");
    assert!((reaction(&simulation, 2) / 105.0 - 1.0).abs() < 1e-9);
    let open = joint.replace(", NO SEPARATION", "");
    let (_scratch, simulation, _) = of_input(&pulled_cubes(&open));
    assert!(reaction(&simulation, 2) < 1e-6);
}

/// Surfaces 0.0005 apart that do not separate: a pull alone finds nothing, and after a push of 0.001 the same pull stretches by 0.001,
/// 210e3 · 0.001 / 2. Pairs that are not there, and friction, are errors.
#[test]
fn surfaces_without_separation_join_when_they_touch() {
    let joint = "*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, NO SEPARATION\n*CONTACT PAIR, INTERACTION=I\nSS, SM\n\
        *CLEARANCE, MASTER=SM, SLAVE=SS, VALUE=0.0005\n";
    let pulled = pulled_cubes(joint).replace("3, 3, 0.001", "3, 3, 0.0005");
    let (_scratch, simulation, _) = of_input(&pulled);
    assert!(reaction(&simulation, 2) < 1e-6);
    let pushed = pulled_cubes(joint).replace("3, 3, 0.001", "3, 3, -0.001");
    let (scratch, simulation, _) =
        of_input(&format!("{pushed}*STEP\n*STATIC\n*BOUNDARY\nTOP, 3, 3, 0.0005\n*END STEP\n"));
    let force = reaction(&simulation, 2);
    // ANALYTIC: the moved body is shorter by the clearance
    assert!((force / 105.0 - 1.0).abs() < 2e-3, "{force}");
    let deck = scratch.path().join("deck/ProjectParameters.json");
    let text = std::fs::read_to_string(&deck).unwrap();
    let friction = text.replace("ALMContactFrictionless", "ALMContactFrictional").replace(
        "\"contact_type\": \"Frictionless\"",
        "\"contact_type\": \"Frictional\", \"friction_coefficients\": {\"0\": 0.2}",
    );
    for (text, fact) in [
        (text.replace("\"no_separation\": [\"0\"]", "\"no_separation\": [\"7\"]"), "names the pair \"7\""),
        (friction, "has \"no_separation\" and friction"),
    ] {
        std::fs::write(&deck, text).unwrap();
        let output = zelus(scratch.path(), &["run", "deck/ProjectParameters.json"]);
        assert!(output.status.code() == Some(2) && said(&output).contains(fact), "{fact}: {}", said(&output));
    }
}

/// An interference of 0.01 by an amplitude that grows, of columns that the mesh lets touch: 210e3 · 0.01 / 2.
#[test]
fn interference_of_abaqus_presses() {
    let joint =
        "*AMPLITUDE, NAME=GROWS\n0., 0., 1., 1.\n*SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I\nSS, SM\n";
    let text =
        pulled_cubes(joint).replace("3, 3, 0.001\n", "3, 3\n*CONTACT INTERFERENCE, AMPLITUDE=GROWS\nSS, SM, -0.01\n");
    let (_scratch, simulation, said) = of_input(&text);
    assert!(!said.contains("warning") && said.contains("it acts in full"), "{said}");
    let (force, wanted) = (reaction(&simulation, 2), 210e3 * 0.01 / 2.0);
    // the moved body is longer by the interference
    assert!((force / wanted - 1.0).abs() < 0.01, "{force} {wanted}");
    // without an amplitude the allowance ends at nothing: surfaces that touch do not press
    let (_scratch, simulation, _) = of_input(&text.replace(", AMPLITUDE=GROWS", ""));
    assert!(reaction(&simulation, 2) < 1e-6);
}

/// A clearance of 0.01 between two columns that the mesh lets touch: of a motion of 0.02 half strains them, 210e3 · 0.01 / 2.
#[test]
fn clearances_of_abaqus_open_surfaces() {
    let joint = "*SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I\nSS, SM\n*CLEARANCE, MASTER=SM, SLAVE=SS, VALUE=0.01\n";
    let text = pulled_cubes(joint).replace("3, 3, 0.001", "3, 3, -0.02");
    let (_scratch, simulation, said) = of_input(&text);
    assert!(!said.contains("warning"), "{said}");
    let force = reaction(&simulation, 2);
    // the moved body is shorter by the clearance
    let wanted = 210e3 * 0.01 / 2.0;
    assert!((force / wanted - 1.0).abs() < 0.01, "{force} {wanted}");
}
