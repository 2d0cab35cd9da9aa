use super::*;
use crate::diagnostics::{Diagnostic, Error, Result};
use std::path::{Path, PathBuf};

fn nodes_of(name: &str) -> Option<usize> {
    // The names of the tests and decks end in their number of nodes: …3D8N, Quadrilateral3D4.
    let digits: String = name.trim_end_matches('N').chars().rev().take_while(char::is_ascii_digit).collect();
    (name != "Elemnt2D3N").then_some(())?;
    digits.chars().rev().collect::<String>().parse().ok()
}

fn names() -> EntityNames<'static> {
    EntityNames { nodes_of: &nodes_of, known: &["Element2D3N", "LineCondition2D2N"], is_flag: &|name| name == "ACTIVE" }
}

fn read_text(text: &str) -> Result<(MdpaDocument, Vec<Diagnostic>)> {
    read_bytes(text.as_bytes(), Path::new("a.mdpa"), &names())
}

/// The problems of a text as `line code`.
fn problems(text: &str) -> Vec<String> {
    let diagnostics = match read_text(text) {
        Ok((_, warnings)) => warnings,
        Err(Error::Input(diagnostics)) => diagnostics,
        Err(other) => panic!("{other}"),
    };
    diagnostics.iter().map(|d| format!("{} {}", d.place.as_ref().unwrap().line, d.code)).collect()
}

const SMALL: &str = "Begin ModelPartData\n  DOMAIN_SIZE 2 // glued\nEnd ModelPartData\n\
    Begin Table 1 TIME DISPLACEMENT_X\n 0 0.5 1 1.5\nEnd Table\n\
    Begin Properties 0\nEnd Properties\n\
    Begin Properties 1\n CONSTITUTIVE_LAW LinearElastic3DLaw\n YOUNG_MODULUS 2.1e11\n\
      VOLUME_ACCELERATION [3] (0.0, -9.81 ,0)\n LOCAL [2,2]((1,2),(3,4))\n\
      Begin Table TEMPERATURE DENSITY\n 0 1 100 0.5\n End Table\nEnd Properties\n\
    Begin Nodes\n 1 0 0 0 2 1.0 0 0 /* several on\n a line */ 3 0 1 0\n4 1 1 1e-3//end\nEnd Nodes\n\
    Begin Elements Element2D3N// comment\n 1 1 1 2 3\n 2 0 2 4 3\nEnd Elements\n\
    Begin Conditions LineCondition2D2N\n 7 0 1 2\nEnd Conditions\n\
    Begin Geometries Line2D2\n 3 1 2\nEnd Geometries\n\
    Begin Constraints LinearMasterSlaveConstraint DISPLACEMENT_X DISPLACEMENT_X\n\
      1 0.5 [0.25, 0.75] 1 2 3\nEnd Constraints\n\
    Begin NodalData DISPLACEMENT_X\n 1 1 0.25\n 2 0 1\nEnd NodalData\n\
    Begin NodalData VELOCITY\n 1 0 [3] (1,2,3)\nEnd NodalData\n\
    Begin NodalData ACTIVE\n 1 2\n3\nEnd NodalData\n\
    Begin ElementalData TEMPERATURE\n 1 3.5\nEnd ElementalData\n\
    Begin ConditionalData LOCAL\n 7 [2,2] ((1,2),(3,4))\nEnd ConditionalData\n\
    Begin SubModelPart Outer\n\
      Begin SubModelPartData\n DELTA_TIME 0.1\n End SubModelPartData\n\
      Begin SubModelPartTables\n 1\n End SubModelPartTables\n\
      Begin SubModelPartProperties\n 1\n End SubModelPartProperties\n\
      Begin SubModelPartNodes\n 1 2 3\n End SubModelPartNodes\n\
      Begin SubModelPart Inner\n Begin SubModelPartElements\n 2\n End SubModelPartElements\n\
        Begin SubModelPartConditions\n 7\n End SubModelPartConditions\n\
        Begin SubModelPartGeometries\n 3\n End SubModelPartGeometries\n\
        Begin SubModelPartConstraints\n 1\n End SubModelPartConstraints\n End SubModelPart\n\
    End SubModelPart\n";

#[test]
fn every_block_is_read() {
    let (document, warnings) = read_text(SMALL).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    assert_eq!(document.model_part_data[0].value, DataValue::Number(2.0));
    assert_eq!(document.model_part_data[0].line.0, 2);
    assert_eq!((document.tables[0].id, &document.tables[0].rows[..]), (Some(1), &[[0.0, 0.5], [1.0, 1.5]][..]));
    let material = &document.properties[1];
    assert_eq!(material.values[0].value, DataValue::Text("LinearElastic3DLaw".into()));
    assert_eq!(material.values[2].value, DataValue::Vector(vec![0.0, -9.81, 0.0]));
    assert_eq!(material.values[3].value, DataValue::Matrix { rows: 2, columns: 2, values: vec![1., 2., 3., 4.] });
    assert_eq!(material.tables[0].rows[1], [100.0, 0.5]);
    assert_eq!(document.nodes.ids, [1, 2, 3, 4]);
    assert_eq!(document.nodes.coordinates[3], [1.0, 1.0, 1e-3]);
    assert_eq!((document.elements[0].nodes_of(1), document.elements[0].properties[1]), (&[2, 4, 3][..], 0));
    assert_eq!((document.conditions[0].ids[0], &document.geometries[0].nodes[..]), (7, &[1, 2][..]));
    let constraint = &document.constraints[0].rows[0];
    assert_eq!((constraint.constant, constraint.slave, &constraint.masters[..]), (0.5, 1, &[2, 3][..]));
    assert_eq!(document.nodal_data[0].values, DataColumn::Scalar { values: vec![0.25, 1.0], fixed: vec![true, false] });
    assert_eq!(document.nodal_data[1].values, DataColumn::Vector { size: 3, values: vec![1.0, 2.0, 3.0] });
    assert_eq!((&document.nodal_data[2].values, &document.nodal_data[2].ids[..]), (&DataColumn::Flag, &[1, 2, 3][..]));
    let outer = &document.sub_model_parts[0];
    assert_eq!((outer.nodes.len(), outer.parts[0].name.as_str(), outer.parts[0].elements[0]), (3, "Inner", 2));
}

#[test]
fn reading_what_was_written_gives_the_same() {
    let (first, _) = read_text(SMALL).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("b.mdpa");
    write(&first, &path).unwrap();
    let (mut second, warnings) = read(&path, &names()).unwrap();
    second.file = first.file.clone();
    assert!(warnings.is_empty());
    assert_eq!(first, second);
}

#[test]
fn a_beginning_of_a_word_is_a_number_with_a_warning() {
    let text = "Begin Nodes\n1.0 1.0D0 0 0\n 2 2x 0 0\nEnd Nodes\n";
    assert_eq!(problems(text), ["2 number-prefix", "3 number-prefix"]);
    let (document, _) = read_text(text).unwrap();
    assert_eq!((document.nodes.ids[0], document.nodes.coordinates[1][0]), (1, 2.0));
}

#[test]
fn legacy_blocks_are_skipped_with_a_warning() {
    let text = "Begin Mesh 1\n Begin MeshNodes\n 1\n End MeshNodes\nEnd Mesh\n\
        Begin CommunicatorData\n NEIGHBOURS_INDICES [2]((0,1))\nEnd CommunicatorData\nBegin Nodes\n1 0 0 0\nEnd Nodes\n";
    assert_eq!(problems(text), ["1 skipped-block", "6 skipped-block"]);
    assert_eq!(read_text(text).unwrap().0.nodes.ids, [1]);
}

#[test]
fn unknown_blocks_and_entities_say_what_was_meant() {
    let text = "Begin Node\n1 0 0 0\nEnd Node\nBegin Elements Elemnt2D3N\n1 0 1 2 3\nEnd Elements\nstray 1\n\
        Begin SubModelPart A\nBegin SubModelPartNode\n1\nEnd SubModelPartNode\nEnd SubModelPart\n";
    assert_eq!(problems(text), ["1 unknown-block", "4 unknown-entity", "7 outside-block", "9 unknown-block"]);
    let said = read_text(text).unwrap_err().to_string();
    assert!(said.contains("did you mean \"Nodes\"") && said.contains("did you mean \"Element2D3N\""), "{said}");
    assert!(said.contains("did you mean \"SubModelPartNodes\""), "{said}");
}

#[test]
fn a_cut_off_file_names_the_block_and_its_line() {
    assert_eq!(problems("\nBegin Nodes\n1 0 0 0\n2 1 0"), ["2 cut-off"]);
    assert_eq!(problems("Begin Properties 1\nDENSITY 1\n"), ["1 cut-off"]);
    assert_eq!(problems("Begin SubModelPart A\nBegin SubModelPartNodes\n"), ["2 cut-off", "1 cut-off"]);
    assert_eq!(problems("Begin Nodes\nEnd Nodes\n/* x\n"), ["3 cut-off"]);
    assert_eq!(problems("Begin Nodes\n1 0 0 0\nBegin Properties 0\nEnd Properties\n"), ["3 not-closed"]);
    assert_eq!(problems("Begin Nodes\n1 0 0 0\nEnd Elements\n"), ["3 wrong-end"]);
}

#[test]
fn bad_rows_are_gathered_with_their_lines() {
    let text = "Begin Nodes\n1 0 0 0\n2 a 0 0\n-3 0 0 0\n4 0 0\nEnd Nodes\n";
    assert_eq!(problems(text), ["3 bad-number", "4 bad-number", "6 short-row"]);
    let data = "Begin Nodes\n1 0 0 0\nEnd Nodes\nBegin NodalData X\n1 2 0.5\n1 1 [3] (1,2,3)\nEnd NodalData\n\
        Begin NodalData Y\n1 0 [3] (1,2\n1\n1 0 [2] (1,2)\n1 0 3\nEnd NodalData\n";
    assert_eq!(problems(data), ["5 bad-number", "6 fixed-vector", "10 bad-value", "12 mixed-shapes"]);
    let many: String = (1..100).map(|i| format!("{i} x 0 0\n")).collect();
    let found = problems(&format!("Begin Nodes\n{many}End Nodes\n"));
    assert_eq!((found.len(), found[50].as_str()), (51, "0 too-many-problems"));
}

#[test]
fn ids_are_defined_once_and_before_use() {
    let nodes = "Begin Properties 0\nEnd Properties\nBegin Nodes\n1 0 0 0\n2 1 0 0\n1 0 0 0\n";
    assert_eq!(problems(&format!("{nodes}2 1 0 1\nEnd Nodes\n")), ["6 repeated-node", "7 repeated-node"]);
    let text = format!(
        "{nodes}End Nodes\nBegin Conditions LineCondition2D2N\n1 0 1 2\n1 0 2 1\n2 0 1 3\n3 5 1 2\nEnd Conditions\n"
    );
    assert_eq!(problems(&text), ["6 repeated-node", "10 repeated-entity", "8 undefined-id", "8 undefined-id"]);
    let many = format!("{nodes}End Nodes\nBegin Conditions PointCondition2D1N\n1 7 1\n2 0 2\n3 7 2\nEnd Conditions\n");
    assert_eq!(problems(&many), ["6 repeated-node", "9 undefined-id"]);
    let parts = format!(
        "{nodes}End Nodes\nBegin SubModelPart A\nBegin SubModelPartNodes\n1 9\nEnd SubModelPartNodes\n\
         Begin SubModelPartElements\n1\nEnd SubModelPartElements\nEnd SubModelPart\n\
         Begin SubModelPart A\nEnd SubModelPart\nBegin NodalData X\n8 0 1\nEnd NodalData\n"
    );
    assert_eq!(
        problems(&parts),
        ["16 repeated-part", "6 repeated-node", "19 undefined-id", "8 undefined-id", "8 undefined-id"]
    );
    let merged = "Begin Properties 1\nA 1\nB 1\nEnd Properties\nBegin Properties 1\nB 2\nEnd Properties\n";
    assert_eq!(problems(merged), ["5 repeated-properties"]);
    assert_eq!(read_text(merged).unwrap().0.properties[0].values[1].value, DataValue::Number(2.0));
}

#[test]
fn a_missing_file_is_bad_input() {
    assert_eq!(read(Path::new("no/such.mdpa"), &names()).unwrap_err().exit_code(), 2);
}

fn shared() -> PathBuf {
    std::env::var_os("ZELUS_SHARED")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared"), PathBuf::from)
}

fn mesh_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            mesh_files(&path, found);
        } else if path.extension().is_some_and(|e| e == "mdpa") {
            found.push(path);
        }
    }
}

#[test]
fn the_decks_are_read_and_survive_writing() {
    let mut files = Vec::new();
    mesh_files(&shared().join("decks"), &mut files);
    if files.is_empty() {
        println!("skipped: no decks in {}", shared().display());
    }
    for file in &files {
        let (first, _) = read(file, &names()).unwrap_or_else(|e| panic!("{e}"));
        assert!(!first.nodes.ids.is_empty() && !first.elements.is_empty());
        let mut text = Vec::new();
        write_to(&first, &mut text).unwrap();
        let (second, warnings) = read_bytes(&text, file, &names()).unwrap();
        assert!(warnings.is_empty() && first == second, "{}", file.display());
    }
}

/// Reads the file of `ZELUS_BIG_MDPA` and prints the speed; `cargo test --release -- --ignored --nocapture speed`.
#[test]
#[ignore = "a measurement"]
fn speed_of_reading() {
    let path = PathBuf::from(std::env::var("ZELUS_BIG_MDPA").expect("ZELUS_BIG_MDPA names an mdpa file"));
    let bytes = std::fs::read(&path).unwrap();
    let start = std::time::Instant::now();
    let (document, _) = read_bytes(&bytes, &path, &names()).unwrap();
    let seconds = start.elapsed().as_secs_f64();
    let megabytes = bytes.len() as f64 / 1e6;
    println!(
        "{} nodes, {megabytes:.1} MB in {seconds:.3} s: {:.0} MB/s",
        document.nodes.ids.len(),
        megabytes / seconds
    );
}

#[test]
fn sub_model_parts_are_nested_so_deep_and_no_deeper() {
    let nested = |depth: usize| {
        let open: String = (0..depth).map(|at| format!("Begin SubModelPart P{at}\n")).collect();
        problems(&format!("{open}{}", "End SubModelPart\n".repeat(depth)))
    };
    assert_eq!(nested(101), Vec::<String>::new());
    assert_eq!(nested(102), ["102 nested-too-deep"]);
    assert_eq!(nested(50_000), ["102 nested-too-deep"]);
}

/// Words of the format may be names of parts, as in Kratos.
#[test]
fn a_part_may_be_called_end() {
    let text = "Begin SubModelPart End\nBegin SubModelPart Begin\nEnd SubModelPart\nEnd SubModelPart\n";
    let (document, _) = read_text(text).unwrap();
    let [part] = &document.sub_model_parts[..] else { panic!("{:?}", document.sub_model_parts) };
    assert_eq!(part.name, "End");
    assert_eq!(part.parts.iter().map(|part| part.name.as_str()).collect::<Vec<_>>(), ["Begin"]);
    assert_eq!(problems("Begin SubModelPart\nEnd SubModelPart\n")[0], "1 bad-heading");
}
