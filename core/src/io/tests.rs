//! Meshes and materials into a model part.

use std::path::Path;

use super::*;
use crate::diagnostics::Error;
use crate::entities::{Build, ConditionEntry, ElementEntry};
use crate::model::test_variables::DISPLACEMENT;
use crate::model::{ModelPart, PropertyValue};
use crate::parameters::Document;
use crate::registered_kind;
use crate::{register, register_variable};

register_variable! {
    kind IO_TEST_MODULUS: Scalar = "A number of a material.";
    kind IO_TEST_COUNT: Integer = "A whole number.";
    kind IO_TEST_MARK: Boolean = "A mark.";
    kind IO_TEST_AXIS: Vector3 = "Three numbers.";
    kind IO_TEST_MATRIX: Matrix = "Numbers in rows.";
}

register! { ElementEntry "IoTestElement2D3N", about: "a triangle of the tests", cell: Some(crate::geometry::Shape::Tri3), space: 2, build: Build::Pairs }
register! { ConditionEntry "IoTestCondition2D2N", about: "a line of the tests", cell: Some(crate::geometry::Shape::Line2), space: 2, build: Build::Pairs }
registered_kind! {
    /// The laws of an application.
    #[expect(dead_code, reason = "the reader asks for names only")]
    pub struct LawEntry("constitutive_law", "unknown-law") {
        build: ();
    }
}
register! { LawEntry "IoTestLaw", about: "a law", build: () }

const MESH: &str = "Begin ModelPartData\n IO_TEST_COUNT 2\nEnd ModelPartData\n\
    Begin Properties 0\nEnd Properties\nBegin Properties 4\n IO_TEST_MODULUS 5.0D0\n IO_TEST_MARK 1\n\
      CONSTITUTIVE_LAW IoTestLaw\n IO_TEST_AXIS [3] (1,2,3)\nEnd Properties\n\
    Begin Nodes\n 9 0 1 0\n 1 0 0 0\n 5 1 0 0\nEnd Nodes\n\
    Begin Elements IoTestElement2D3N\n 3 0 1 5 9\nEnd Elements\n\
    Begin Conditions IoTestCondition2D2N\n 8 4 5 9\n 2 0 1 5\nEnd Conditions\n\
    Begin NodalData DISPLACEMENT_Y\n 5 1 0.5\n 9 0 2\nEnd NodalData\n\
    Begin NodalData VELOCITY\n 1 0 [3] (1,2,3)\nEnd NodalData\nBegin NodalData SLAVE\n 9\nEnd NodalData\n\
    Begin ElementalData IO_TEST_MODULUS\n 3 7.5\nEnd ElementalData\n\
    Begin Constraints LinearMasterSlaveConstraint DISPLACEMENT_X\n 1 0.5 [2.0] 9 1\nEnd Constraints\n\
    Begin SubModelPart Outer\n Begin SubModelPartNodes\n 1\n End SubModelPartNodes\n\
      Begin SubModelPart Inner\n Begin SubModelPartNodes\n 9 5 9\n End SubModelPartNodes\n\
        Begin SubModelPartConditions\n 8\n End SubModelPartConditions\n End SubModelPart\nEnd SubModelPart\n\
    Begin SubModelPart Body\n Begin SubModelPartElements\n 3\n End SubModelPartElements\nEnd SubModelPart\n";

fn mesh(text: &str) -> crate::Result<(ModelPart, Vec<crate::diagnostics::Diagnostic>)> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mdpa");
    std::fs::write(&path, text).unwrap();
    let mut part = ModelPart::new("Structure");
    part.nodes.history.add(&DISPLACEMENT);
    part.nodes.history.set_levels(2);
    let warnings = read_mesh(&path, &mut part)?;
    Ok((part, warnings))
}

fn codes(result: crate::Result<impl Sized>) -> Vec<(u32, &'static str)> {
    match result.err().unwrap() {
        Error::Input(problems) => problems.iter().map(|d| (d.place.as_ref().map_or(0, |p| p.line), d.code)).collect(),
        other => panic!("{other}"),
    }
}

#[test]
fn a_mesh_becomes_a_model_part() {
    let (part, warnings) = mesh(MESH).unwrap();
    assert_eq!(warnings.iter().map(|d| d.code).collect::<Vec<_>>(), ["number-prefix"]);
    assert_eq!((&part.nodes.ids[..], part.nodes.initial[1]), (&[1, 5, 9][..], [1.0, 0.0, 0.0]));
    assert_eq!((part.elements.nodes(0), &part.conditions.ids[..]), (&[0, 1, 2][..], &[2, 8][..]));
    assert_eq!((part.conditions.nodes(1), part.conditions.properties[1]), (&[1, 2][..], 4));
    assert_eq!(part.nodes.history.values(&DISPLACEMENT, 0), [0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 2.0, 0.0]);
    assert_eq!(part.nodes.history.levels(), 2);
    let fixed: Vec<bool> = (0..3).map(|node| part.nodes.is_fixed(DISPLACEMENT.component(1), node)).collect();
    assert_eq!(fixed, [false, true, false]);
    assert!(part.nodes.flags.is("SLAVE", 2) && part.nodes.flags.get("SLAVE", 0).is_none());
    assert_eq!(*part.elements.data.get("IO_TEST_MODULUS").unwrap().levels[0], [7.5]);
    let material = &part.properties[&4];
    assert_eq!((material.number("IO_TEST_MODULUS"), material.law.as_deref()), (Some(5.0), Some("IoTestLaw")));
    assert_eq!(
        (material.vector3("IO_TEST_AXIS"), &part.data["IO_TEST_COUNT"]),
        (Some([1.0, 2.0, 3.0]), &PropertyValue::Number(2.0))
    );
    assert_eq!(
        (part.constraints[0].slave.0, part.constraints[0].masters[0].1, part.constraints[0].constant),
        (2, 2.0, 0.5)
    );
    let outer = part.part("Structure.Outer").unwrap();
    assert_eq!((&outer.nodes[..], &outer.conditions[..]), (&[0, 1, 2][..], &[1][..]));
    assert_eq!(part.part("Structure.Outer.Inner").unwrap().nodes, [1, 2]);
    assert_eq!(part.tree.nodes, [0, 1, 2]);
}

#[test]
fn names_that_are_not_registered_are_gathered() {
    let text = "Begin Properties 0\n IO_TEST_MODULUZ 1\n IO_TEST_AXIS 1\n CONSTITUTIVE_LAW NoLaw\nEnd Properties\n\
        Begin Nodes\n1 0 0 0\n2 1 0 0\nEnd Nodes\nBegin Elements IoTestCondition2D2N\n1 0 1 2\nEnd Elements\n\
        Begin NodalData VELOCITI\n1 0 [3] (1,2,3)\nEnd NodalData\nBegin NodalData VELOCITY\n1 0 1\nEnd NodalData\n";
    let found = codes(mesh(text));
    let wanted = [
        (10, "unknown-element"),
        (2, "unknown-variable"),
        (3, "wrong-type"),
        (4, "unknown-law"),
        (13, "unknown-variable"),
        (16, "wrong-size"),
    ];
    assert_eq!(found, wanted);
}

fn materials(text: &str, part: &mut ModelPart) -> crate::Result<Vec<crate::diagnostics::Diagnostic>> {
    apply_materials(&Document::from_str(text, Path::new("m.json"))?.root, part)
}

#[test]
fn materials_complete_properties_and_are_given_to_parts() {
    let (mut part, _) = mesh(MESH).unwrap();
    let text = r#"{"properties": [
        {"model_part_name": "Structure", "properties_id": 4, "Material": {
            "Variables": {"IO_TEST_MODULUS": 7, "App.IO_TEST_MATRIX": [[1, 2], [3, 4]]},
            "Tables": {"t": {"input_variable": "TIME", "output_variable": "App.IO_TEST_MODULUS", "data": [[0, 1], [1, 3]]}}}},
        {"model_part_name": "Structure.Outer.Inner", "properties_id": 6, "label": "x",
         "Material": {"constitutive_law": {"name": "App.IoTestLaw"}, "Variables": {"IO_TEST_MARK": true}, "Tables": {}}}]}"#;
    materials(text, &mut part).unwrap();
    let merged = &part.properties[&4];
    assert_eq!((merged.number("IO_TEST_MODULUS"), merged.law.as_deref()), (Some(7.0), Some("IoTestLaw")));
    assert_eq!(merged.values["IO_TEST_MARK"], PropertyValue::Boolean(true));
    assert_eq!(merged.tables[&("TIME".to_owned(), "IO_TEST_MODULUS".to_owned())].value(0.5), 2.0);
    assert_eq!((part.elements.properties[0], &part.conditions.properties[..]), (4, &[4, 6][..]));
    assert_eq!(part.properties[&6].law.as_deref(), Some("IoTestLaw"));
    assert_eq!(
        (&part.part("Structure.Outer").unwrap().properties[..], &part.tree.properties[..]),
        (&[6][..], &[0, 4, 6][..])
    );
}

#[test]
fn parts_without_root_are_found_where_they_are_one() {
    let (mut part, _) = mesh(MESH).unwrap();
    let text = r#"{"properties": [{"model_part_name": "Inner", "properties_id": 6}]}"#;
    let warnings = materials(text, &mut part).unwrap();
    assert!(warnings[0].to_string().contains("\"Structure.Outer.Inner\" is taken"), "{}", warnings[0]);
    assert_eq!(part.part("Structure.Outer").unwrap().properties[..], [6]);
    assert!(part.named_without_root("Inne").is_none());
}

#[test]
fn problems_of_a_materials_file_are_gathered_with_places() {
    let (mut part, _) = mesh(MESH).unwrap();
    let text = r#"{"properties": [
        {"model_part_name": "Structure.Outer.Inner", "properties_id": 1,
         "Material": {"constitutive_law": {"name": "IoTestLow"}, "Variables": {"IO_TEST_MODULUS": "5"}}},
        {"model_part_name": "Structure.Outer", "properties_id": 2},
        {"model_part_name": "Outside", "properties_id": 3},
        {"model_part_name": "Structure.Outer", "properties_id": 2, "Material": {"Variables": {"NOPE": 1}}},
        {"properties_id": 1}]}"#;
    let found = codes(materials(text, &mut part));
    let wanted = [
        (3, "unknown-law"),
        (3, "wrong-type"),
        (4, "material-order"),
        (5, "unknown-model-part"),
        (6, "repeated-material"),
        (6, "repeated-properties"),
        (6, "unknown-variable"),
        (7, "missing-key"),
    ];
    assert_eq!(found, wanted);
}
