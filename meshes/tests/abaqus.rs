//! Input files with instances, surfaces, pairs, supports and loads.

use std::path::Path;

use zelus_core::geometry::mapping;
use zelus_core::io::format_of;
use zelus_meshes::Mesh;
use zelus_meshes::mesh::{LoadKind, Pair};

fn read(path: &Path) -> zelus_core::Result<(Mesh, String)> {
    let (mesh, said) = zelus_meshes::read(path, format_of(path).unwrap())?;
    Ok((mesh, said.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")))
}

fn of_text(text: &str) -> zelus_core::Result<(Mesh, String)> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("test.inp");
    std::fs::write(&path, text).unwrap();
    read(&path)
}

fn blocks() -> Mesh {
    let (mesh, said) = read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/blocks.inp")).unwrap();
    assert_eq!(said, "");
    mesh
}

#[test]
fn instances_are_placed_and_their_sets_named() {
    let mesh = blocks();
    assert_eq!((mesh.points.len(), mesh.node_ids.last()), (16, Some(&16)));
    // node 1 of the upper block: up by 1, then a quarter turn about the axis through (0.5, 0.5)
    let corner = mesh.points[8];
    assert!(corner.iter().zip([1.0, 0.0, 1.0]).all(|(a, b)| (a - b).abs() < 1e-12), "{corner:?}");
    for (name, nodes) in [("LOWER_Low", 4), ("UPPER_Low", 4), ("LOWER_Edge", 2), ("Side", 2)] {
        assert_eq!(mesh.group(name).unwrap_or_else(|| panic!("{name}")).nodes.len(), nodes, "{name}");
    }
}

#[test]
fn surfaces_point_outward_and_make_pairs() {
    let mesh = blocks();
    for (name, z, up) in [("UPPER_Under", 1.0, -1.0), ("LOWER_Over", 1.0, 1.0), ("UPPER_Over", 2.0, 1.0)] {
        let cell = mesh.group(name).unwrap().cells[0] as usize;
        let (shape, points) = (mesh.cells.shapes[cell], mesh.points_of(cell));
        assert!((mapping::centre(shape, &points)[2] - z).abs() < 1e-12, "{name}");
        assert!((mapping::vector_area(shape, &points)[2] - up).abs() < 1e-12, "{name}");
    }
    let pair = Pair { tied: false, slave: "UPPER_Under".into(), master: "LOWER_Over".into(), friction: 0.3 };
    assert_eq!(mesh.pairs, [pair]);
}

#[test]
fn materials_supports_and_loads_are_kept() {
    let mesh = blocks();
    let steel = &mesh.materials[0];
    assert_eq!((steel.young, steel.poisson, steel.density), (Some(1000.0), 0.0, 7.8));
    assert_eq!(mesh.sections.len(), 2);
    let held: Vec<_> = mesh.supports.iter().map(|support| (support.group.as_str(), support.values)).collect();
    assert_eq!(held, [("LOWER_Low", [Some(0.0); 3]), ("Side", [Some(0.0), Some(0.0), None])]);
    assert_eq!(mesh.loads[0].kind, LoadKind::Pressure(10.0));
}

const TRIANGLE: &str = "*NODE\n1,0,0\n2,1,0\n3,0,1\n*ELEMENT,TYPE=CPS3,ELSET=E\n7,1,2,3\n";

#[test]
fn what_is_not_read_is_said() {
    let (_, said) = of_text(&format!("{TRIANGLE}*TRANSFORM,NSET=N\n1,0,0,0,1,0\n*PLASTIC\n1,2\n")).unwrap();
    assert!(said.contains("not read: PLASTIC, TRANSFORM"), "{said}");
}

#[test]
fn elements_that_come_in_as_simpler_ones_are_named() {
    let square = "*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n";
    for (kind, what) in [("CPS4I", "incompatible modes"), ("CPE4R", "one integration point"), ("CPE4H", "a pressure")] {
        let (_, said) = of_text(&format!("{square}*ELEMENT,TYPE={kind}\n7,1,2,3,4\n")).unwrap();
        assert!(said.contains(&format!("elements {kind} have {what}")), "{said}");
    }
    let (_, said) = of_text(&format!("{square}*ELEMENT,TYPE=CPS4\n7,1,2,3,4\n")).unwrap();
    assert!(!said.contains("elements CPS4"), "{said}");
}

#[test]
fn what_does_not_fit_is_refused_with_its_line() {
    for (text, fact, line) in [
        ("*ELEMENT,TYPE=CPS3\n8,1,2,9\n", "element 8 has node 9, which is not there", 7),
        ("*ELEMENT,TYPE=C3D5\n8,1,2,3,4,5\n", "elements of type C3D5 are not known", 7),
        ("*NSET,NSET=A\nB\n", "there is no node or set of nodes B", 7),
        ("*SURFACE,NAME=S\nE,S4\n", "element 7 has no face \"S4\"", 7),
        ("*NODE\n1,0,0\n", "node 1 stands there twice", 7),
        ("*NODE\n9,x,0\n", "\"x\" is no number", 7),
        ("*CONTACT PAIR\nA,B\n", "a pair names the surface A", 0),
    ] {
        let error = of_text(&format!("{TRIANGLE}{text}")).unwrap_err().to_string();
        assert!(error.contains(fact), "{error}");
        assert!(line == 0 || error.contains(&format!("test.inp:{line}")), "{error}");
    }
}

#[test]
fn pressures_on_faces_of_elements_become_a_part() {
    let text = format!("{TRIANGLE}*BOUNDARY\n1,1,2\n*STEP\n*DLOAD\nE,P2,4.\n*CLOAD\n3,2,-5.\n*STEP\n*CLOAD\n3,2,-6.\n");
    let (mesh, said) = of_text(&text).unwrap();
    assert!(said.contains("*CLOAD of step 2 is left out"), "{said}");
    let loads: Vec<_> = mesh.loads.iter().map(|load| (load.group.as_str(), load.kind)).collect();
    assert_eq!(loads, [("Node_3", LoadKind::Force([0.0, -5.0, 0.0])), ("Pressure_1", LoadKind::Pressure(4.0))]);
    let cell = mesh.group("Pressure_1").unwrap().cells[0] as usize;
    assert!((mapping::domain_size(mesh.cells.shapes[cell], &mesh.points_of(cell)) - 2.0_f64.sqrt()).abs() < 1e-12);
    assert_eq!(mesh.supports[0].group, "Node_1");
}
