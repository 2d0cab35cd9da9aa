//! Surfaces of interfaces in results: a point for each slave node, also where several stand at a mesh node.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::{Value, json};
use zelus::core::communication::Ranks;
use zelus::core::geometry::Shape;
use zelus::core::io::results::{Dataset, read_pvd, read_vtu};
use zelus::{RunOptions, Silent, Simulation};

use crate::blocks::{Deck, Joint};
use crate::scene::{COMPONENTS, Corner, FRICTIONLESS, Scene, corner, die};
use crate::second_order::stack;
use crate::support::{contents, read_json, root, scratch_copy};
use crate::thread_ranks::on_threads;

const DECK: &str = "ProjectParameters.json";
const FOLDER: &str = "VTU_Output";

/// Adds an output process to the deck of a folder.
fn add_output(folder: &Path, module: &str, parameters: Value) {
    let mut deck = read_json(&folder.join(DECK)).expect("a deck");
    let mut parameters = parameters;
    parameters["model_part_name"] = json!("Structure");
    deck["output_processes"] = json!({"pictures": [{"python_module": module, "kratos_module": "KratosMultiphysics",
        "Parameters": parameters}]});
    std::fs::write(folder.join(DECK), deck.to_string()).expect("a file");
}

fn with_surfaces() -> Value {
    json!({"interface_surfaces": true, "write_deformed_configuration": true})
}

fn open(folder: &Path, ranks: Ranks) -> zelus::core::Result<Simulation> {
    Simulation::open(&folder.join(DECK), &RunOptions { threads: Some(1), ranks, ..RunOptions::default() })
}

fn run(folder: &Path, ranks: Ranks) -> Simulation {
    let mut simulation = open(folder, ranks).expect("a deck");
    simulation.run(&mut Silent).expect("it converges");
    simulation
}

/// A scene with surfaces, run.
fn of_scene(scene: &Scene) -> (tempfile::TempDir, Simulation) {
    let folder = tempfile::tempdir().expect("a scratch folder");
    scene.write(folder.path());
    add_output(folder.path(), "vtu_output_process", with_surfaces());
    let simulation = run(folder.path(), Ranks::default());
    (folder, simulation)
}

/// The surface of an interface in a step.
fn surface(folder: &Path, number: usize, step: usize) -> Dataset {
    read_vtu(&folder.join(FOLDER).join(format!("Structure.interface_{number}_{step}.vtu"))).expect("a surface")
}

fn column(data: &Dataset, name: &str) -> Vec<f64> {
    let names: Vec<&str> = data.point_data.iter().map(|column| column.name.as_str()).collect();
    let column = data.point_data.iter().find(|column| column.name == name);
    let column = column.unwrap_or_else(|| panic!("no {name} in {names:?}"));
    (0..column.values.len()).map(|at| column.values.get(at)).collect()
}

fn vectors(data: &Dataset, name: &str) -> Vec<[f64; 3]> {
    column(data, name).as_chunks().0.to_vec()
}

/// Sum over the points of a surface of vectors times areas.
fn sum(data: &Dataset, of: &[[f64; 3]]) -> [f64; 3] {
    let areas = column(data, "NODAL_AREA");
    std::array::from_fn(|c| of.iter().zip(&areas).map(|(vector, area)| vector[c] * area).sum())
}

/// Sum of the reactions of nodes, numbered from 1.
fn reaction(simulation: &Simulation, nodes: &[usize]) -> [f64; 3] {
    let part = simulation.part().expect("a part");
    let field = part.nodes.history.get("REACTION").expect("reactions");
    let of = |id: &usize| field.vector(0, part.nodes.ids.iter().position(|own| own == id).expect("a node"));
    std::array::from_fn(|c| nodes.iter().map(|node| of(node)[c]).sum())
}

fn assert_near(found: [f64; 3], right: [f64; 3], tolerance: f64, what: &str) {
    let near = found.iter().zip(right).all(|(a, b)| (a - b).abs() <= tolerance);
    assert!(near, "{what}: {found:?} in place of {right:?}");
}

/// ANALYTIC: uniaxial strain. The floor presses with the load 1, the walls with ν/(1 − ν). Forces on deformed faces, which stretch by
/// about 1e-3, give the tolerance. The lower corners of the block have two slave nodes each.
#[test]
fn a_corner_shows_the_pressure_of_each_of_its_faces() {
    let (scene, _) = die(2, 0.0, 1.0, FRICTIONLESS, true);
    let (folder, simulation) = of_scene(&scene);
    let data = surface(folder.path(), 0, 1);
    let (ids, patches) = (column(&data, "KRATOS_NODE_ID"), column(&data, "PATCH"));
    let (pressures, normals) = (column(&data, "CONTACT_PRESSURE"), vectors(&data, "NORMAL"));
    let lateral = scene.poisson / (1.0 - scene.poisson);
    let mut at_node: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
    for (at, (normal, pressure)) in normals.iter().zip(&pressures).enumerate() {
        at_node.entry(ids[at] as i64).or_default().push(at);
        let right = if normal[1] < -0.5 { 1.0 } else { lateral };
        assert!((pressure - right).abs() < 5e-3, "node {}: {pressure}, not {right}", ids[at]);
    }
    let several: Vec<&Vec<usize>> = at_node.values().filter(|points| points.len() > 1).collect();
    assert_eq!((several.len(), data.points.len(), data.cells.len()), (2, 3 * 5, 3 * 4));
    for points in several {
        let &[one, other] = points.as_slice() else { panic!("{points:?}") };
        assert!(patches[one] != patches[other] && data.points[one] == data.points[other], "{points:?}");
        assert!((pressures[one] - pressures[other]).abs() > 0.5 * (1.0 - lateral), "{pressures:?}");
    }
    let part = simulation.part().expect("a part");
    for ((id, place), u) in ids.iter().zip(&data.points).zip(vectors(&data, "DISPLACEMENT")) {
        let node = part.nodes.ids.iter().position(|own| *own as f64 == *id).expect("a node");
        assert_eq!(
            (u, *place),
            (part.nodes.history.get("DISPLACEMENT").expect("a column").vector(0, node), part.nodes.current[node])
        );
    }
    for (flag, right) in [("ACTIVE", 1.0), ("CONTACT_STATUS", 2.0)] {
        assert!(column(&data, flag).iter().all(|state| *state == right), "{flag}");
    }
    // The facets close up: each inner node of a face belongs to two lines of it, an end to one.
    let mut met = vec![0; data.points.len()];
    for (shape, points) in data.cells.iter() {
        assert_eq!(shape, Shape::Line2);
        assert!(patches[points[0] as usize] == patches[points[1] as usize]);
        points.iter().for_each(|&point| met[point as usize] += 1);
    }
    assert_eq!(met.iter().filter(|count| **count == 1).count(), 6);
}

/// ANALYTIC: equilibrium. Multiplier times scale factor times area is the force of an interface, for each of the pairs that meet at the
/// corner. The tolerance is that of Newton's iteration, 1e-10 of the load.
#[test]
fn pressures_of_each_surface_balance_its_reaction() {
    for kind in [FRICTIONLESS, COMPONENTS] {
        let Corner { mut scene, floor, wall } = corner(5);
        scene.loads = vec![("Top", [0.0, -1.0, 0.0]), ("Right", [-0.5, 0.0, 0.0])];
        scene.pairs = vec![["Bottom", "FloorTop"], ["Left", "WallFace"]];
        (scene.kind, scene.steps) = (kind, 2);
        let (folder, simulation) = of_scene(&scene);
        for (number, nodes) in [(0, &floor), (1, &wall)] {
            let data = surface(folder.path(), number, 2);
            let force = sum(&data, &vectors(&data, "CONTACT_TRACTION"));
            assert_near(force, reaction(&simulation, nodes), 1e-8, &format!("{kind:?}, surface {number}"));
        }
        let corner = |number: usize| {
            let data = surface(folder.path(), number, 2);
            let at = data.points.iter().position(|x| x[0].abs() < 0.1 && x[1].abs() < 0.1).expect("the corner");
            (column(&data, "KRATOS_NODE_ID")[at], column(&data, "CONTACT_PRESSURE")[at])
        };
        let [(node, floor), (same, wall)] = [corner(0), corner(1)];
        assert!(node == same && (floor - wall).abs() > 0.1, "{kind:?}: {floor} {wall} at nodes {node} and {same}");
    }
}

/// ANALYTIC: equilibrium, as above, of a tie and a pair at one corner. The multiplier of a tie times the scale factor is the traction on
/// the master, against that on the slave.
#[test]
fn ties_have_surfaces_too() {
    let Corner { mut scene, floor, wall } = corner(5);
    scene.loads = vec![("Top", [0.0, -1.0, 0.0]), ("Right", [-0.5, 0.0, 0.0])];
    (scene.ties, scene.pairs) = (vec![["Bottom", "FloorTop"]], vec![["Left", "WallFace"]]);
    let (folder, simulation) = of_scene(&scene);
    let (tie, contact) = (surface(folder.path(), 0, 1), surface(folder.path(), 1, 1));
    let scale = simulation.part().expect("a part").info.value_or("SCALE_FACTOR", 0.0);
    let tractions: Vec<[f64; 3]> =
        vectors(&tie, "VECTOR_LAGRANGE_MULTIPLIER").into_iter().map(|value| value.map(|x| -scale * x)).collect();
    assert_near(sum(&tie, &tractions), reaction(&simulation, &floor), 1e-8, "the tie");
    let force = sum(&contact, &vectors(&contact, "CONTACT_TRACTION"));
    assert_near(force, reaction(&simulation, &wall), 1e-8, "the contact");
    assert!(column(&tie, "ACTIVE").iter().all(|active| *active == 1.0));
    let series = std::fs::read_to_string(folder.path().join(FOLDER).join("Structure.pvd")).expect("the series");
    for line in [
        "part=\"0\" file=\"Structure_1.vtu\"",
        "part=\"1\" name=\"tie 0: Bottom on FloorTop\" file=\"Structure.interface_0_1.vtu\"",
        "part=\"2\" name=\"contact 0: Left on WallFace\" file=\"Structure.interface_1_1.vtu\"",
    ] {
        assert!(series.contains(line), "no {line} in {series}");
    }
    assert_eq!(read_pvd(&folder.path().join(FOLDER).join("Structure.pvd")).expect("a series").len(), 2);
}

/// ANALYTIC: a uniform pressure of 1 on a face of area 1, by facets of second order. The blocks are so stiff that the load acts on the
/// undeformed face; the tolerance is that of Newton's iteration.
#[test]
fn facets_of_second_order_keep_their_nodes() {
    let faces = [(2, false, false, Shape::Line3), (3, true, false, Shape::Tri6), (3, false, false, Shape::Quad8)];
    for (space, simplices, full, shape) in faces.into_iter().chain([(3, false, true, Shape::Quad9)]) {
        let mesh = stack(space, [(simplices, Some(full)); 2], true);
        let holds = |axis: usize| std::array::from_fn(|c| if c == axis { json!(0.0) } else { Value::Null });
        let planes = ["PlaneX", "PlaneY"].into_iter().enumerate().take(space - 1);
        let supports = planes.chain([(space - 1, "Bottom")]).map(|(axis, name)| (name.to_owned(), holds(axis)));
        let (supports, joint) = (supports.collect(), Joint::Frictionless);
        let deck = Deck { mesh, joint, supports, pressure: 1.0, young: 1e11, steps: 1 };
        let folder = tempfile::tempdir().expect("a scratch folder");
        deck.write(folder.path(), |_| {});
        add_output(folder.path(), "vtu_output_process", with_surfaces());
        run(folder.path(), Ranks::default());
        let data = surface(folder.path(), 0, 1);
        assert!(!data.cells.is_empty() && data.cells.iter().all(|(own, _)| own == shape), "{shape:?}");
        let pressures = column(&data, "CONTACT_PRESSURE");
        let force: f64 = pressures.iter().zip(column(&data, "NODAL_AREA")).map(|(p, area)| p * area).sum();
        assert!((force - 1.0).abs() < 1e-8, "{shape:?}: {force}");
    }
}

#[test]
fn without_the_key_there_are_no_surfaces_and_old_ones_go() {
    let (mut scene, _) = die(2, 0.0, 1.0, FRICTIONLESS, true);
    scene.steps = 2;
    let (folder, _) = of_scene(&scene);
    let files = || -> Vec<String> {
        let files = contents(&folder.path().join(FOLDER)).into_keys();
        files.map(|file| file.display().to_string()).collect()
    };
    assert_eq!(files().iter().filter(|file| file.contains("interface")).count(), 3, "{:?}", files());
    add_output(folder.path(), "vtu_output_process", json!({}));
    run(folder.path(), Ranks::default());
    assert_eq!(files(), ["Structure.pvd", "Structure_0.vtu", "Structure_1.vtu", "Structure_2.vtu"]);
    let series = std::fs::read_to_string(folder.path().join(FOLDER).join("Structure.pvd")).expect("the series");
    assert!(!series.contains("interface"), "{series}");
}

#[test]
fn legacy_files_have_surfaces_and_formats_without_them_are_refused() {
    let (scene, _) = die(2, 0.0, 1.0, FRICTIONLESS, true);
    let folder = tempfile::tempdir().expect("a scratch folder");
    scene.write(folder.path());
    let with_format = |format: &str| {
        let parameters = json!({"interface_surfaces": true, "file_format": format});
        add_output(folder.path(), "vtk_output_process", parameters);
    };
    with_format("ascii");
    run(folder.path(), Ranks::default());
    let text = std::fs::read_to_string(folder.path().join("VTK_Output/Structure.interface_0_0_1.vtk")).expect("a file");
    assert!(text.contains("POINTS 15 float") && text.contains("CONTACT_PRESSURE 1 15  float"), "{text}");
    with_format("vtkhdf");
    let mut simulation = open(folder.path(), Ranks::default()).expect("a deck");
    let error = simulation.run(&mut Silent).expect_err("no surfaces in this format").to_string();
    assert!(error.contains("\"vtkhdf\" hold no surfaces of interfaces"), "{error}");
}

/// In self contact all facets that may become slaves are cells; nodes that are no slaves in the step have the status -1.
#[test]
fn self_contact_shows_which_side_is_the_slave() {
    let scratch = scratch_copy(&root().join("tests/cases/self_contact/slit"));
    add_output(scratch.path(), "vtu_output_process", with_surfaces());
    let simulation = run(scratch.path(), Ranks::default());
    let data = surface(scratch.path(), 0, simulation.part().expect("a part").info.step);
    let (status, areas) = (column(&data, "CONTACT_STATUS"), column(&data, "NODAL_AREA"));
    assert!(status.contains(&-1.0) && status.iter().any(|state| *state >= 0.0), "{status:?}");
    assert!(status.iter().zip(areas).all(|(state, area)| *state >= 0.0 || area == 0.0));
}

/// A restart writes the same files, to the last bit.
#[test]
fn a_restart_writes_the_same_surfaces() {
    let Corner { mut scene, .. } = corner(5);
    scene.loads = vec![("Top", [0.0, -1.0, 0.0]), ("Right", [-0.5, 0.0, 0.0])];
    (scene.ties, scene.pairs) = (vec![["Bottom", "FloorTop"]], vec![["Left", "WallFace"]]);
    scene.steps = 3;
    let (straight, _) = of_scene(&scene);
    let folder = tempfile::tempdir().expect("a scratch folder");
    scene.write(folder.path());
    add_output(folder.path(), "vtu_output_process", with_surfaces());
    let file = folder.path().join("saved.rest");
    let mut simulation = open(folder.path(), Ranks::default()).expect("a deck");
    assert!(simulation.step(&mut Silent).expect("it converges"));
    simulation.save(&file).expect("a saved run");
    let saved = simulation.part().expect("a part").interface_surfaces.clone();
    // A run has its files for itself.
    drop(simulation);
    let mut simulation = open(folder.path(), Ranks::default()).expect("a deck");
    simulation.load(&file, &mut Silent).expect("the same deck");
    assert_eq!(simulation.part().expect("a part").interface_surfaces, saved);
    simulation.run(&mut Silent).expect("it converges");
    let [found, right] = [&folder, &straight].map(|folder| contents(&folder.path().join(FOLDER)));
    assert!(found.keys().eq(right.keys()) && right.len() == 13, "{:?}", found.keys());
    assert!(found == right, "other contents");
}

#[test]
fn a_deck_without_slave_nodes_is_warned() {
    let (scene, _) = die(2, 0.0, 1.0, FRICTIONLESS, true);
    let folder = tempfile::tempdir().expect("a scratch folder");
    scene.write(folder.path());
    let mut deck = read_json(&folder.path().join(DECK)).expect("a deck");
    let parameters = json!({"model_part_name": "Structure.Top", "interface_surfaces": true});
    deck["output_processes"] = json!({"pictures": [{"python_module": "vtu_output_process",
        "kratos_module": "KratosMultiphysics", "Parameters": parameters}]});
    std::fs::write(folder.path().join(DECK), deck.to_string()).expect("a file");
    let simulation = run(folder.path(), Ranks::default());
    let warnings = &simulation.report().warnings;
    assert!(warnings.iter().any(|text| text.contains("Structure.Top has no facets with slave nodes")), "{warnings:?}");
}

/// Surfaces are whole on every rank and rank 0 writes them. Values agree to round-off: 1e-9 of the largest of their column.
#[test]
fn surfaces_are_the_same_on_any_number_of_ranks() {
    for case in ["contact_2d/friction_arc", "contact_3d/hexahedra_nonmatching", "mesh_tying/coarse_slave"] {
        let written = |count: usize| {
            let scratch = scratch_copy(&root().join("tests/cases").join(case));
            add_output(scratch.path(), "vtu_output_process", with_surfaces());
            let steps = on_threads(count, |ranks| run(scratch.path(), ranks).part().expect("a part").info.step);
            let series =
                std::fs::read_to_string(scratch.path().join(FOLDER).join("Structure.pvd")).expect("the series");
            let file = format!("file=\"Structure.interface_0_{}.vtu\"", steps[0]);
            assert!(series.contains(&file), "{case}: {series}");
            surface(scratch.path(), 0, steps[0])
        };
        let (alone, shared) = (written(1), written(3));
        assert_eq!((&shared.cells, shared.points.len()), (&alone.cells, alone.points.len()), "{case}");
        for (found, right) in shared.point_data.iter().zip(&alone.point_data) {
            assert_eq!((&found.name, found.values.len()), (&right.name, right.values.len()), "{case}");
            let largest = (0..right.values.len()).map(|at| right.values.get(at).abs()).fold(0.0, f64::max);
            for at in 0..right.values.len() {
                let (a, b) = (found.values.get(at), right.values.get(at));
                assert!((a - b).abs() <= 1e-9 * largest, "{case}: {} is {a}, not {b}, at {at}", right.name);
            }
        }
    }
}
