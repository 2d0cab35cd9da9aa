//! Input files with instances, surfaces, pairs, supports and loads.

use std::path::Path;

use zelus_core::geometry::mapping;
use zelus_core::io::format_of;
use zelus_meshes::Mesh;
use zelus_meshes::conditions::LoadKind;
use zelus_meshes::history::History;
use zelus_meshes::mesh::Pair;

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
    for (name, nodes) in [("LOWER_Low", 4), ("UPPER_Low", 4), ("Edge", 2), ("Side", 2)] {
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
    let pair = Pair { friction: 0.3, ..Pair::of("UPPER_Under".into(), "LOWER_Over".into()) };
    assert_eq!(mesh.pairs, [pair]);
}

#[test]
fn materials_supports_and_loads_are_kept() {
    let mesh = blocks();
    let steel = &mesh.materials[0];
    assert_eq!((steel.young, steel.poisson, steel.density), (Some(1000.0), 0.0, 7.8));
    assert_eq!(mesh.sections.len(), 2);
    let value = |value: &Option<History>| value.as_ref().and_then(History::as_constant);
    let held: Vec<_> =
        mesh.supports.iter().map(|support| (support.group.as_str(), support.values.each_ref().map(value))).collect();
    assert_eq!(held, [("LOWER_Low", [Some(0.0); 3]), ("Side", [Some(0.0), Some(0.0), None])]);
    assert_eq!(mesh.loads[0].kind, LoadKind::Pressure(History::ramp(1.0, 10.0)));
}

const TRIANGLE: &str = "*NODE\n1,0,0\n2,1,0\n3,0,1\n*ELEMENT,TYPE=CPS3,ELSET=E\n7,1,2,3\n";

/// The message that names each line: file, line, and the fact.
fn assert_says(said: &str, line: u32, fact: &str) {
    let place = format!("test.inp:{line}: ");
    assert!(said.lines().any(|own| own.contains(&place) && own.contains(fact)), "{line}: {fact}: {said}");
}

#[test]
fn commas_at_the_end_of_keywords_go_on_in_parameters_alone() {
    let text = format!("{TRIANGLE}*MATERIAL,NAME=M\n*ELASTIC,\n70.,0.33\n*SOLID SECTION,\nELSET=E,\nMATERIAL=M\n2.\n");
    let (mesh, said) = of_text(&text).unwrap();
    assert_eq!(said, "");
    assert_eq!((mesh.materials[0].young, mesh.materials[0].poisson), (Some(70.0), 0.33));
    assert_eq!((mesh.sections[0].group.as_str(), mesh.sections[0].thickness), ("E", 2.0));
}

#[test]
fn cards_and_parameters_that_are_not_read_are_named_with_their_lines() {
    let text = format!(
        "{TRIANGLE}*TRANSFORM,NSET=N\n1,0,0,0,1,0\n*VISCOELASTIC\n1,2\n*STEP\n*STATIC\n*BOUNDARY,SUBMODEL\n1,1,2\n*FILM\n*FILM\n"
    );
    let (mesh, said) = of_text(&text).unwrap();
    assert_eq!((mesh.points.len(), mesh.supports.len()), (3, 1));
    assert_says(&said, 7, "there is no node or set of nodes N");
    assert_says(&said, 9, "*VISCOELASTIC is not read");
    assert_says(&said, 13, "SUBMODEL of *BOUNDARY is not read");
    assert_says(&said, 15, "*FILM is not read (lines 15, 16)");
    assert!(!said.contains("HEADING") && !said.contains("END STEP"), "{said}");
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

/// One line that cannot be read never costs the file.
#[test]
fn lines_that_do_not_fit_are_left_out_and_named() {
    for (text, fact, line) in [
        ("*ELEMENT,TYPE=CPS3\n8,1,2,9\n", "element 8 has node 9, which is not there", 8),
        ("*ELEMENT,TYPE=C3D7\n8,1,2,3,4,5\n", "elements of type C3D7 are not known", 7),
        ("*NSET,NSET=A\nB\n", "there is no node or set of nodes B", 8),
        ("*SURFACE,NAME=S\nE,S4\n", "element 7 has no face \"S4\"", 8),
        ("*NODE\n1,0,0\n", "node 1 stands there twice", 8),
        ("*NODE\n9,x,0\n", "\"x\" is no number", 8),
        ("*CONTACT PAIR\nA,B\n", "there is no surface A", 8),
        ("*INCLUDE, INPUT=nothing.inp\n", "there is no file", 7),
        ("*SOLID SECTION, ELSET=X, MATERIAL=M\n", "there is no set of elements X", 7),
        ("*CLOAD, AMPLITUDE=X\n1,1,2.\n", "there is no *AMPLITUDE X", 7),
        ("*EQUATION\n99999999999\n1,1,1.\n", "an equation has too few terms", 8),
        ("*EQUATION\n2\n1,1,1.,2,7,1.\n", "degree of freedom 7 is no displacement", 9),
        ("*MPC\nBEAM,1,2\n", "kind BEAM is not known", 8),
        ("*SPRING, ELSET=X\n1\n5.\n", "*SPRING: X has no SPRING1, SPRING2, SPRINGA", 7),
        ("*ELEMENT,TYPE=MASS,ELSET=W\n9,2\n*MASS,ELSET=W\n-1.\n", "a mass of -1 is negative", 10),
        (
            "*SURFACE INTERACTION,NAME=I\n*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=EXPONENTIAL\n1.,2.\n",
            "PRESSURE-OVERCLOSURE of",
            8,
        ),
        ("*CONTACT INTERFERENCE\nA,B,1.\n", "there is no surface A", 8),
        ("*STEP\n*STATIC\n*BOUNDARY,FIXED\n1,1\n", "FIXED holds nodes", 10),
        ("*CLOAD\n1,11,2.\n", "degree of freedom 11 is no displacement", 8),
    ] {
        let (mesh, said) = of_text(&format!("{TRIANGLE}{text}")).unwrap();
        assert_says(&said, line, fact);
        assert_eq!(mesh.cells.len(), 1, "{text}");
    }
    let error = of_text("*NODE\n1,0,0\n*ELEMENT,TYPE=C3D7\n8,1\n").unwrap_err().to_string();
    assert!(error.contains("no elements"), "{error}");
}

#[test]
fn files_of_any_encoding_and_line_end_are_read() {
    let plain = format!("*HEADING\nTräger\n{TRIANGLE}*NSET,NSET=Süd\n1,2\n");
    let latin: Vec<u8> = plain.chars().map(|c| c as u8).collect();
    let marked = [b"\xEF\xBB\xBF".to_vec(), plain.clone().into_bytes()].concat();
    let wide: Vec<u8> = "\u{feff}".encode_utf16().chain(plain.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    let mac = plain.replace('\n', "\r").into_bytes();
    let windows = plain.replace('\n', "\r\n").into_bytes();
    for bytes in [latin, marked, wide, mac, windows] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("test.inp");
        std::fs::write(&path, bytes).unwrap();
        let (mesh, said) = read(&path).unwrap();
        assert_eq!((mesh.cells.len(), mesh.group("Süd").unwrap().nodes.len(), said.as_str()), (1, 2, ""));
    }
}

/// Sets of nodes, sets of elements and surfaces have names of their own.
#[test]
fn sets_of_different_kinds_with_one_name_stay_apart() {
    let text =
        format!("{TRIANGLE}*NSET,NSET=TOP\n1\n*ELSET,ELSET=TOP\n7\n*SURFACE,NAME=TOP\nE,S2\n*BOUNDARY\nTop,1,2\n");
    let (mesh, said) = of_text(&text).unwrap();
    assert_eq!(said, "");
    let size = |name: &str| mesh.group(name).map(|group| (group.nodes.len(), group.cells.len()));
    assert_eq!(["TOP", "TOP_Elements", "TOP_Surface"].map(size), [Some((1, 0)), Some((0, 1)), Some((0, 1))]);
    assert_eq!(mesh.supports[0].group, "TOP");
}

fn loads_of(text: &str) -> Vec<(String, LoadKind)> {
    let (mesh, said) = of_text(text).unwrap();
    assert_eq!(said, "");
    mesh.loads.into_iter().map(|load| (load.group, load.kind)).collect()
}

/// Loads of one step add up, those of a later one replace them.
#[test]
fn loads_of_steps_add_up_or_replace() {
    let text = format!(
        "{TRIANGLE}*NSET,NSET=N\n1,3\n*STEP\n*STATIC\n*DLOAD\nE,P2,4.\n*DLOAD\nE,P2,1.\n*CLOAD\n3,2,-5.\nN,2,-1.\n3,1,2.\n\
         *END STEP\n*STEP\n*STATIC\n*CLOAD\n3,2,-6.\n*END STEP\n"
    );
    let force = |x: History, y: History| LoadKind::Force([x, y, History::default()]);
    let step = |first: f64, second: f64| History::ramp(1.0, first).then(1.0, [[2.0, second]]);
    let loads = loads_of(&text);
    let groups: Vec<&str> = loads.iter().map(|load| load.0.as_str()).collect();
    assert_eq!(groups, ["Node_1", "Node_3", "Pressure_1"]);
    assert_eq!(loads[0].1, force(History::default(), History::ramp(1.0, -1.0)));
    assert_eq!(loads[1].1, force(History::ramp(1.0, 2.0), step(-6.0, -6.0)));
    assert_eq!(loads[2].1, LoadKind::Pressure(History::ramp(1.0, 5.0)));
}

#[test]
fn supports_of_later_steps_begin_and_end_with_them() {
    let text = format!(
        "{TRIANGLE}*BOUNDARY\n1,1,2\n*STEP\n*STATIC\n*BOUNDARY\n2,2\n*END STEP\n*STEP\n*STATIC\n1.,4.\n*BOUNDARY,OP=NEW\n1,1,2\n\
         *BOUNDARY,TYPE=VELOCITY\n3,1,1,0.5\n*END STEP\n"
    );
    let (mesh, said) = of_text(&text).unwrap();
    assert_eq!(said, "");
    let spans: Vec<_> = mesh.supports.iter().map(|support| (support.group.as_str(), support.interval)).collect();
    assert_eq!(spans, [("Node_1", (0.0, None)), ("Node_2", (0.0, Some(1.0))), ("Node_3", (1.0, None))]);
    let moved = mesh.supports[2].values[0].clone().unwrap();
    assert_eq!([moved.at(1.0), moved.at(3.0), moved.at(5.0)], [0.0, 1.0, 2.0]);
    assert_eq!(mesh.steps.iter().map(|step| step.end).collect::<Vec<_>>(), [1.0, 5.0]);
}

#[test]
fn transformed_nodes_have_forces_and_supports_along_their_axes() {
    let text = format!(
        "{TRIANGLE}*NSET,NSET=N\n2,3\n*TRANSFORM,NSET=N,TYPE=C\n0,0,0,0,0,1\n*BOUNDARY\nN,2\n*STEP\n*STATIC\n*CLOAD\nN,1,3.\n*END STEP\n"
    );
    let (mesh, said) = of_text(&text).unwrap();
    assert_eq!(said, "");
    assert!(matches!(mesh.supports[0].axes, Some(zelus_meshes::conditions::Axes::Cylindrical { .. })));
    assert_eq!(mesh.supports[0].values.each_ref().map(Option::is_some), [false, true, false]);
    let at_end = |kind: &LoadKind| match kind {
        LoadKind::Force(values) => values.each_ref().map(|value| value.at(1.0)),
        other => panic!("{other:?}"),
    };
    let forces: Vec<_> = mesh.loads.iter().map(|load| (load.group.as_str(), at_end(&load.kind))).collect();
    assert_eq!(forces, [("Node_2", [3.0, 0.0, 0.0]), ("Node_3", [0.0, 3.0, 0.0])]);
}

#[test]
fn pressures_on_faces_of_elements_become_a_part() {
    let (mesh, _) = of_text(&format!("{TRIANGLE}*BOUNDARY\n1,1,2\n*STEP\n*DLOAD\nE,P2,4.\n")).unwrap();
    let cell = mesh.group("Pressure_1").unwrap().cells[0] as usize;
    assert!((mapping::domain_size(mesh.cells.shapes[cell], &mesh.points_of(cell)) - 2.0_f64.sqrt()).abs() < 1e-12);
    assert_eq!(mesh.supports[0].group, "Node_1");
}

/// CalculiX reads keywords and parameters with blanks and without.
#[test]
fn blanks_in_keywords_do_not_matter() {
    let text = format!(
        "{TRIANGLE}*NODE\n9,0,0\n*MATERIAL,NAME=M\n*ELASTIC\n1000.,0.3\n*SOLIDSECTION,ELSET=E,MATERIAL=M\n0.5\n*NSET,NSET=N\n1,2,3\n\
         *RIGIDBODY,NSET=N,REFNODE=9\n*STEP\n*STATIC\n*NODEPRINT,NSET=N\nU\n*ENDSTEP\n"
    );
    let (mesh, said) = of_text(&text).unwrap();
    assert!(!said.contains("warning"), "{said}");
    assert_eq!((mesh.sections[0].thickness, mesh.couplings.len()), (0.5, 1));
}

/// A later set changes the temperature of nodes that an earlier one has, too.
#[test]
fn temperatures_are_those_of_the_last_card_of_a_node() {
    let text = format!(
        "{TRIANGLE}*NSET,NSET=ALL\n1,2,3\n*NSET,NSET=ONE\n1\n*INITIAL CONDITIONS,TYPE=TEMPERATURE\nALL,20.\n\
         *MATERIAL,NAME=M\n*EXPANSION\n1e-5\n*STEP\n*STATIC\n*TEMPERATURE\nONE,70.\n*END STEP\n"
    );
    let (mesh, said) = of_text(&text).unwrap();
    assert_eq!(said, "");
    let of = |node: u32| {
        let own = mesh.temperatures.iter().find(|own| mesh.group(&own.group).unwrap().nodes.contains(&node));
        [0.0, 0.5, 1.0].map(|time| own.unwrap().value.at(time))
    };
    assert_eq!([of(0), of(1)], [[20.0, 45.0, 70.0], [20.0; 3]]);
    assert_eq!(mesh.materials[0].expansion.as_ref().unwrap().reference, 20.0);
}

#[test]
fn elements_with_more_nodes_than_their_type_and_of_two_plane_states_are_named() {
    let text = format!("{TRIANGLE}*NODE\n4,1,1\n*ELEMENT,TYPE=CPE3\n8,2,4,3,1,1\n");
    let (mesh, said) = of_text(&text).unwrap();
    assert_says(&said, 9, "1 element has more nodes than CPE3");
    assert_says(&said, 9, "elements of type CPE3 assume another plane state");
    assert_eq!(mesh.cells.nodes(1), [1, 3, 2]);
}
