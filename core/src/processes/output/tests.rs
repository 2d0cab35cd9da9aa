//! Each output process on a model of two quadrilaterals whose Gauss values are known.

use std::ops::Range;
use std::path::Path;

use crate::assembly::System;
use crate::diagnostics::{Error, Report, Result};
use crate::entities::{EntityBlock, EntityError, Gauss, LocalSystems, LocalUnknown, Request, StepView, Tangent};
use crate::geometry::Shape;
use crate::model::test_variables::{DISPLACEMENT, SLAVE};
use crate::model::{EntityKind, EntityRole, Model, ModelPart, Nodes, SubPart};
use crate::parameters::Document;
use crate::processes::{Process, ProcessEntry, ProcessRequest};
use crate::register_variable;
use crate::registry::{self, Entry};

register_variable! {
    kind OUTPUT_TEST_VECTOR: Vector = "A vector at Gauss points.";
    kind OUTPUT_TEST_PRESSURE: Scalar = "A number.";
}
static QUADRILATERAL: EntityKind = EntityKind {
    cell: Some(Shape::Quad4),
    space: 2,
    ..EntityKind::new(EntityRole::Element, Entry::new("OutputTestElement2D4N", file!(), line!()))
};
static LINE: EntityKind = EntityKind {
    cell: Some(Shape::Line2),
    space: 2,
    ..EntityKind::new(EntityRole::Condition, Entry::new("OutputTestCondition2D2N", file!(), line!()))
};

/// Two entities with two Gauss points each: values (e, e + p), weights 1 and 3, first point at the first two nodes.
struct Fake {
    entry: &'static EntityKind,
    nodes: Vec<[u32; 4]>,
}

impl EntityBlock for Fake {
    fn entry(&self) -> &'static EntityKind {
        self.entry
    }
    fn members(&self) -> &[u32] {
        &[0, 1]
    }
    fn nodes(&self, at: usize) -> &[u32] {
        &self.nodes[at]
    }
    fn unknowns(&self) -> &[LocalUnknown] {
        &[]
    }
    fn tangent(&self) -> Tangent {
        Tangent::Zero
    }
    fn is_active(&self, _: usize, _: &StepView<'_>) -> bool {
        true
    }
    fn local_systems(
        &self,
        _: &StepView<'_>,
        _: Range<usize>,
        _: Request,
        _: &mut LocalSystems,
    ) -> Result<(), EntityError> {
        Ok(())
    }
    fn gauss(&self, _: &StepView<'_>, _: &str, at: usize) -> Option<Gauss> {
        let e = at as f64;
        let shape = vec![0.5, 0.5, 0.0, 0.0, 0.0, 0.0, 0.5, 0.5];
        Some(Gauss { components: 2, values: vec![e, e, e, e + 1.0], weights: vec![1.0, 3.0], shape })
    }
    fn gauss_variables(&self) -> &'static [&'static str] {
        &["OUTPUT_TEST_VECTOR"]
    }
}

/// Nodes 2 4 6 8 10 12 on a strip; elements 1 and 3, condition 5; node values DISPLACEMENT = (id, 10 id, 0).
fn model() -> Model {
    let mut part = ModelPart::new("Structure");
    let positions = (0..6).map(|i| [f64::from(i % 3), f64::from(i / 3), 0.0]).collect();
    part.nodes = Nodes::new((1..=6).map(|i| 2 * i).collect(), positions);
    let connectivity = [[0, 1, 4, 3], [1, 2, 5, 4]];
    let quad = &QUADRILATERAL;
    let line = &LINE;
    part.elements.push(1, quad, 7, &connectivity[0]);
    part.elements.push(3, quad, 8, &connectivity[1]);
    part.conditions.push(5, line, 0, &[0, 1]);
    part.elements.finish();
    part.conditions.finish();
    for node in 0..6 {
        let id = part.nodes.ids[node] as f64;
        part.nodes.history.values_mut(&DISPLACEMENT, 0)[3 * node..][..2].copy_from_slice(&[id, 10.0 * id]);
    }
    part.nodes.flags.set(SLAVE, 1, true);
    part.nodes.flags.set(SLAVE, 2, false);
    part.tree.nodes = (0..6).collect();
    part.tree.elements = vec![0, 1];
    part.tree.conditions = vec![0];
    let edge = SubPart { nodes: vec![0, 1], conditions: vec![0], ..SubPart::new("Edge") };
    part.tree.children.insert("Edge".into(), edge);
    let mut model = Model::default();
    model.parts.insert("Structure".into(), part);
    model
}

/// The block over the elements of [`model`].
fn system() -> System {
    let entry = &QUADRILATERAL;
    let fake = Fake { entry, nodes: vec![[0, 1, 4, 3], [1, 2, 5, 4]] };
    System { elements: vec![Box::new(fake)], ..System::default() }
}

fn make(name: &str, parameters: &str, model: &mut Model, folder: &Path) -> (Result<Box<dyn Process>>, Report) {
    let entry = registry::find::<ProcessEntry>(name).unwrap();
    let document = Document::from_str(parameters, "deck.json").unwrap();
    let mut report = Report::new();
    let (parameters, results) = (&document.root, folder);
    let request = &mut ProcessRequest { entry, parameters, model, folder, results, report: &mut report };
    let made = (entry.build)(request);
    (made, report)
}

/// Runs steps of length `dt`, with DISPLACEMENT multiplied by the step.
fn run(process: &mut dyn Process, model: &mut Model, steps: usize, dt: f64) -> Result<()> {
    let system = system();
    process.initialize(model)?;
    process.before_loop(model)?;
    model.root_mut("Structure")?.info = Default::default();
    let first = model.parts["Structure"].nodes.history.values(&DISPLACEMENT, 0).to_vec();
    let mut time = 0.0;
    for step in 1..=steps {
        time += dt;
        let part = model.root_mut("Structure")?;
        part.info.step = step;
        part.clone_time_step(time);
        let now = part.nodes.history.values_mut(&DISPLACEMENT, 0);
        now.iter_mut().zip(&first).for_each(|(now, first)| *now = first * step as f64);
        process.end_step(model, &system)?;
        if process.is_output_step(model) {
            process.print_output(model, &system)?;
        }
    }
    process.finalize(model)
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = entries.collect();
    names.sort();
    names
}

#[test]
fn vtk_files_are_named_and_filled_as_in_kratos() {
    let (folder, mut model) = (tempfile::tempdir().unwrap(), model());
    std::fs::create_dir(folder.path().join("out")).unwrap();
    for file in ["Structure_0_7.vtk", "Structure_Edge_0_7.500.vtk", "Strange_0_7.vtk", "notes.txt"] {
        std::fs::write(folder.path().join("out").join(file), "").unwrap();
    }
    let parameters = r#"{"model_part_name": "Structure", "file_format": "ascii", "folder_name": "out",
        "output_control_type": "time", "output_frequency": 0.2, "output_sub_model_parts": true, "write_ids": true,
        "nodal_solution_step_data_variables": ["DISPLACEMENT"], "nodal_data_value_variables": ["NORMAL"],
        "nodal_flags": ["SLAVE"], "gauss_point_variables_extrapolated_to_nodes": ["OUTPUT_TEST_VECTOR"],
        "gauss_point_variables_in_elements": ["OUTPUT_TEST_VECTOR"], "output_precision": 3}"#;
    let (process, report) = make("vtk_output_process", parameters, &mut model, folder.path());
    assert_eq!(report.diagnostics().len(), 2, "old spellings are warned of");
    run(process.unwrap().as_mut(), &mut model, 10, 0.1).unwrap();
    let parts = ["0.200", "0.400", "0.700", "0.900"]
        .map(|t| [format!("Structure_0_{t}.vtk"), format!("Structure_Edge_0_{t}.vtk")]);
    let mut wanted = parts.concat();
    wanted.extend(["notes.txt".into(), "Strange_0_7.vtk".into()]);
    wanted.sort();
    assert_eq!(names(&folder.path().join("out")), wanted);
    let text = std::fs::read_to_string(folder.path().join("out/Structure_0_0.200.vtk")).unwrap();
    let after = |key: &str| text.split_once(key).unwrap_or_else(|| panic!("{key} in {text}")).1.to_owned();
    assert!(after("CELLS 2 10\n").starts_with("4 0 1 4 3\n4 1 2 5 4\n"));
    assert!(
        after("POINT_DATA 6\nFIELD FieldData 5\nDISPLACEMENT 3 6  float\n")
            .starts_with("4.000e+00 4.000e+01 0.000e+00 \n")
    );
    assert!(after("NORMAL 3 6  float\n").starts_with("0.000e+00 0.000e+00 0.000e+00 \n"));
    // Node 2 sees e = 0 with weights 1/2; node 4 both elements; nodes above e + 1 in the second component.
    assert!(after("OUTPUT_TEST_VECTOR 2 6  float\n").starts_with(
        "0.000e+00 0.000e+00 \n5.000e-01 5.000e-01 \n1.000e+00 1.000e+00 \n0.000e+00 1.000e+00 \n5.000e-01 1.500e+00 \n"
    ));
    assert!(after("SLAVE 1 6  float\n").starts_with("-1.000e+00\n1.000e+00\n0.000e+00\n-1.000e+00\n"));
    assert!(
        after("CELL_DATA 2\nFIELD FieldData 3\nOUTPUT_TEST_VECTOR 2 2  float\n")
            .starts_with("0.000e+00 5.000e-01 \n1.000e+00 1.500e+00 \n")
    );
    assert!(text.ends_with("PROPERTIES_ID 1 2  int\n7\n8\nKRATOS_ELEMENT_ID 1 2  int\n1\n3\n"));
    let edge = std::fs::read_to_string(folder.path().join("out/Structure_Edge_0_0.200.vtk")).unwrap();
    assert!(
        edge.contains("POINTS 2 float") && edge.contains("CELLS 1 3\n2 0 1\n") && edge.contains("KRATOS_CONDITION_ID")
    );
}

#[test]
fn vtu_files_come_with_a_series() {
    let (folder, mut model) = (tempfile::tempdir().unwrap(), model());
    let parameters = r#"{"model_part_name": "Structure", "output_interval": 2, "nodal_solution_step_data_variables": ["DISPLACEMENT"]}"#;
    let mut process = make("vtu_output_process", parameters, &mut model, folder.path()).0.unwrap();
    run(process.as_mut(), &mut model, 5, 0.5).unwrap();
    assert_eq!(names(&folder.path().join("VTU_Output")), ["Structure.pvd", "Structure_2.vtu", "Structure_4.vtu"]);
    let pvd = std::fs::read_to_string(&process.outputs()[0]).unwrap();
    assert!(pvd.contains("timestep=\"1.0\" part=\"0\" file=\"Structure_2.vtu\""), "{pvd}");
}

#[test]
fn json_is_written_by_the_strict_counter_and_checks_itself() {
    let (folder, mut model) = (tempfile::tempdir().unwrap(), model());
    let parameters = r#"{"model_part_name": "Structure", "sub_model_part_name": "Edge", "output_file_name": "r/a.json",
        "output_variables": ["DISPLACEMENT"], "time_frequency": 0.1}"#;
    let mut process = make("json_output_process", parameters, &mut model, folder.path()).0.unwrap();
    run(process.as_mut(), &mut model, 7, 0.1).unwrap();
    let text = std::fs::read_to_string(folder.path().join("r/a.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    // Sums of 0.1: the counter exceeds 0.1 where a difference of two times does.
    let times: Vec<f64> = json["TIME"].as_array().unwrap().iter().map(|t| t.as_f64().unwrap()).collect();
    assert_eq!(times, [0.2, 0.30000000000000004, 0.5, 0.7]);
    let node = json["NODE_4"].as_object().unwrap();
    assert_eq!(node.keys().collect::<Vec<_>>(), ["DISPLACEMENT_X", "DISPLACEMENT_Y", "DISPLACEMENT_Z"]);
    assert_eq!(node["DISPLACEMENT_X"], serde_json::json!([8.0, 12.0, 20.0, 28.0]));
    assert!(text.starts_with("{\n  \"TIME\": [\n    0.2,\n"), "{text}");

    let check = |tolerance: f64, scale: f64| {
        let mut model = self::model();
        let part = model.root_mut("Structure").unwrap();
        part.nodes.history.values_mut(&DISPLACEMENT, 0).iter_mut().for_each(|u| *u *= scale);
        let parameters = format!(
            r#"{{"model_part_name": "Structure.Edge", "input_file_name": "r/a.json", "time_frequency": 0.0,
            "check_variables": ["DISPLACEMENT"], "tolerance": {tolerance}, "reference_uncertainty": 0.0}}"#
        );
        let mut process = make("from_json_check_result_process", &parameters, &mut model, folder.path()).0.unwrap();
        run(process.as_mut(), &mut model, 7, 0.1)
    };
    // Between and beyond the times of the file the reference is a line, as the values are.
    check(1e-3, 1.0).unwrap();
    check(1e-3, 1.0 + 1e-6).unwrap();
    let error = check(1e-3, 1.01).unwrap_err();
    assert_eq!(error.exit_code(), 4);
    assert!(error.to_string().contains("NODE_2 DISPLACEMENT component 1: 2.02e1, expected 2.0"), "{error}");
    check(30.0, 1.01).unwrap();
}

#[test]
fn json_filters_by_flag_sums_up_and_holds_gauss_points() {
    let (folder, mut model) = (tempfile::tempdir().unwrap(), model());
    let read = |name: &str| -> serde_json::Value {
        serde_json::from_str(&std::fs::read_to_string(folder.path().join(name)).unwrap()).unwrap()
    };
    let flagged = r#"{"model_part_name": "Structure", "output_file_name": "f.json", "time_frequency": 0.0, "check_for_flag": "SLAVE",
        "output_variables": ["DISPLACEMENT_X"], "use_node_coordinates": true}"#;
    let mut process = make("json_output_process", flagged, &mut model, folder.path()).0.unwrap();
    run(process.as_mut(), &mut model, 1, 0.1).unwrap();
    let wanted = serde_json::json!({"TIME": [0.1], "NODE_X_1.000000_Y_0.000000_Z_0.000000": {"DISPLACEMENT_X": [4.0]}});
    assert_eq!(read("f.json"), wanted);

    let sums = r#"{"model_part_name": "Structure.Edge", "output_file_name": "s.json", "time_frequency": 0.0,
        "output_variables": ["DISPLACEMENT_X"], "resultant_solution": true}"#;
    let mut process = make("json_output_process", sums, &mut model, folder.path()).0.unwrap();
    run(process.as_mut(), &mut model, 1, 0.1).unwrap();
    assert_eq!(read("s.json"), serde_json::json!({"TIME": [0.1], "RESULTANT": {"DISPLACEMENT_X": [6.0]}}));

    // A quantity is found where it is kept, whichever columns the process asks for.
    let elsewhere = r#"{"model_part_name": "Structure.Edge", "output_file_name": "e.json", "time_frequency": 0.0,
        "output_variables": ["DISPLACEMENT_X"], "resultant_solution": true, "historical_value": false}"#;
    let mut process = make("json_output_process", elsewhere, &mut model, folder.path()).0.unwrap();
    run(process.as_mut(), &mut model, 1, 0.1).unwrap();
    assert_eq!(read("e.json")["RESULTANT"], read("s.json")["RESULTANT"]);

    let gauss = r#"{"model_part_name": "Structure", "output_file_name": "g.json", "time_frequency": 0.0,
        "gauss_points_output_variables": ["OUTPUT_TEST_VECTOR"]}"#;
    let mut process = make("json_output_process", gauss, &mut model, folder.path()).0.unwrap();
    run(process.as_mut(), &mut model, 2, 0.1).unwrap();
    let points = serde_json::json!({"0": [[1.0, 1.0], [1.0, 1.0]], "1": [[1.0, 2.0], [1.0, 2.0]]});
    assert_eq!(read("g.json")["ELEMENT_3"]["OUTPUT_TEST_VECTOR"], points);
    let check = r#"{"model_part_name": "Structure", "input_file_name": "g.json", "time_frequency": 0.0,
        "gauss_points_check_variables": ["OUTPUT_TEST_VECTOR"]}"#;
    let mut process = make("from_json_check_result_process", check, &mut model, folder.path()).0.unwrap();
    run(process.as_mut(), &mut model, 2, 0.1).unwrap();
}

#[test]
fn gid_writes_text_and_says_so() {
    let (folder, mut model) = (tempfile::tempdir().unwrap(), model());
    let parameters = r#"{"model_part_name": "Structure", "output_name": "solution", "postprocess_parameters": {
        "result_file_configuration": {"gidpost_flags": {"GiDPostMode": "GiD_PostBinary", "WriteConditionsFlag": "WriteConditions"},
            "file_label": "step", "output_frequency": 2, "nodal_results": ["DISPLACEMENT"], "nodal_flags_results": ["SLAVE"],
            "gauss_point_results": ["OUTPUT_TEST_VECTOR"]}, "point_data_configuration": []}}"#;
    let (process, report) = make("gid_output_process", parameters, &mut model, folder.path());
    let codes: Vec<&str> = report.diagnostics().iter().map(|d| d.code).collect();
    assert!(codes.contains(&"gid-text") && codes.contains(&"deprecated-key"), "{codes:?}");
    run(process.unwrap().as_mut(), &mut model, 4, 0.1).unwrap();
    let list = folder.path().file_name().unwrap().to_string_lossy().into_owned() + ".post.lst";
    let mut wanted = vec![list.clone(), "solution.post.msh".into(), "solution.post.res".into()];
    wanted.sort();
    assert_eq!(names(folder.path()), wanted);
    assert_eq!(std::fs::read_to_string(folder.path().join(list)).unwrap(), "Single\nsolution.post.res\n");
    let mesh = std::fs::read_to_string(folder.path().join("solution.post.msh")).unwrap();
    assert!(
        mesh.contains("Elements\n1 2 4 10 8 7\n3 4 6 12 10 8\nEnd") && mesh.contains("Elements\n5 2 4 0\nEnd"),
        "{mesh}"
    );
    assert_eq!(mesh.matches("\n12 ").count(), 1);
    let results = std::fs::read_to_string(folder.path().join("solution.post.res")).unwrap();
    assert_eq!(results.matches("GiD Post Results File").count(), 1);
    assert!(
        results.contains("Result \"DISPLACEMENT\" \"Kratos\" 2.0 Vector OnNodes\nValues\n2 4.0 40.0 0.0\n"),
        "{results}"
    );
    assert!(results.contains("\"Kratos\" 4.0 Scalar OnNodes\nValues\n2 -1.0\n4 1.0\n"), "{results}");
    assert!(results.contains("Values\n1 0.0 0.0\n 0.0 1.0\n3 1.0 1.0\n 1.0 2.0\nEnd Values"), "{results}");
}

#[test]
fn a_point_has_its_history() {
    let (folder, mut model) = (tempfile::tempdir().unwrap(), model());
    let parameters = |x: f64| {
        format!(
            r#"{{"model_part_name": "Structure", "position": [{x}, 0.5, 0.0], "output_variables": ["DISPLACEMENT", "OUTPUT_TEST_PRESSURE"],
            "interval": [0.15, "End"], "output_file_settings": {{"file_name": "point", "output_path": "out"}}}}"#
        )
    };
    let mut process = make("point_output_process", &parameters(1.25), &mut model, folder.path()).0.unwrap();
    run(process.as_mut(), &mut model, 2, 0.1).unwrap();
    let text = std::fs::read_to_string(folder.path().join("out/point.dat")).unwrap();
    let wanted = "# Results for \"element\" at position: x: 1.25; y: 0.5; z: 0.0\n\
        # time DISPLACEMENT_X DISPLACEMENT_Y DISPLACEMENT_Z OUTPUT_TEST_PRESSURE\n0.2 15.0 150.0 0.0 0.0\n";
    assert_eq!(text, wanted);
    let mut outside = make("point_output_process", &parameters(2.25), &mut model, folder.path()).0.unwrap();
    let error = outside.initialize(&mut model).unwrap_err();
    assert!(error.to_string().contains("point-outside"), "{error}");
}

/// Node 2 sees e = 0, node 4 both elements; nodes above e + 1 in the second component.
#[test]
fn gauss_values_become_fields_of_the_nodes() {
    let (folder, mut model) = (tempfile::tempdir().unwrap(), model());
    let name = "integration_values_extrapolation_to_nodes_process";
    for (history, area) in [(true, true), (false, false)] {
        let parameters = format!(
            r#"{{"model_part_name": "Structure", "list_of_variables": ["OUTPUT_TEST_VECTOR"],
            "extrapolate_non_historical": {}, "area_average": {area}}}"#,
            !history
        );
        run(make(name, &parameters, &mut model, folder.path()).0.unwrap().as_mut(), &mut model, 1, 0.1).unwrap();
        let nodes = &model.parts["Structure"].nodes;
        let field = if history { &nodes.history } else { &nodes.values }.get("OUTPUT_TEST_VECTOR").unwrap();
        assert_eq!(*field.levels[0], [0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 0.0, 1.0, 0.5, 1.5, 1.0, 2.0]);
    }
}

#[test]
fn two_files_are_compared() {
    let (folder, mut model) = (tempfile::tempdir().unwrap(), model());
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("a.dat"), "# run 1\n0.1 2.0e0, x\n\n0.2 -0\n").unwrap();
    let mut compare = |content: &str, way: &str| {
        std::fs::write(path("b.dat"), content).unwrap();
        let parameters = format!(
            r#"{{"reference_file_name": "a.dat", "output_file_name": "b.dat", "comparison_type": "{way}",
            "tolerance": 1e-9, "relative_tolerance": 1e-6}}"#
        );
        let mut process = make("compare_two_files_check_process", &parameters, &mut model, folder.path()).0?;
        process.finalize(&mut model)
    };
    assert!(compare("# run 2\n0.1 2.000001 x\n0.2 1e-10\n", "dat_file").is_ok());
    assert!(!path("b.dat").exists(), "removed when it is the same");
    let refused = [
        ("0.1 2.00001 x\n0.2 0\n", "dat_file", "line 2 of the reference is \"0.1 2.0e0, x\""),
        ("0.1 2 y\n0.2 0\n", "dat_file", "line 2"),
        ("0.1 2 x\n", "csv_file", "line 4 of the reference is missing"),
        ("0.1 2 x\n0.2 0\n0.3 0\n", "vtk", "line 3 is not in the reference"),
        ("# run 2\n", "deterministic", "byte 7 differs"),
        ("", "xml", "\"comparison_type\" is \"xml\""),
    ];
    for (content, way, words) in refused {
        let error = compare(content, way).unwrap_err().to_string();
        assert!(error.contains(words), "no {words:?} in {error}");
        assert!(path("b.dat").exists());
    }
}

#[test]
fn points_of_a_list_a_line_and_a_table_have_their_histories() {
    let (folder, mut model) = (tempfile::tempdir().unwrap(), model());
    std::fs::write(folder.path().join("points.csv"), "y, x,z\n0.5,0.25,0.0\n\n0.5,1.25,0\n").unwrap();
    let head = |x: f64| {
        let name = format!("# Results for \"element\" at position: x: {x:?}; y: 0.5; z: 0.0");
        format!("{name}\n# time DISPLACEMENT_X\n")
    };
    let ways = [
        ("multiple_points_output_process", r#""positions": [[0.25, 0.5, 0.0], [1.25, 0.5, 0.0]]"#),
        ("line_output_process", r#""start_point": [0.25, 0.5, 0], "end_point": [1.25, 0.5, 0], "sampling_points": 2"#),
        ("csv_points_output_process", r#""csv_file_path": "points.csv""#),
    ];
    for (name, points) in ways {
        let parameters = format!(
            r#"{{"model_part_name": "Structure", {points}, "output_variables": ["DISPLACEMENT_X"],
            "output_file_settings": {{"file_name": "{name}.dat"}}}}"#
        );
        let mut process = make(name, &parameters, &mut model, folder.path()).0.unwrap();
        assert_eq!(process.outputs().len(), 2, "{name}");
        run(process.as_mut(), &mut model, 1, 0.1).unwrap();
        for (number, x, value) in [(1, 0.25, "5.5"), (2, 1.25, "7.5")] {
            let text = std::fs::read_to_string(folder.path().join(format!("{name}_{number}.dat"))).unwrap();
            assert_eq!(text, format!("{}0.1 {value}\n", head(x)), "{name}");
        }
    }
    let wrong = r#"{"model_part_name": "Structure", "csv_file_path": "none.csv", "output_variables": ["DISPLACEMENT_X"],
        "output_file_settings": {"file_name": "a"}}"#;
    let error = make("csv_points_output_process", wrong, &mut model, folder.path()).0.err().unwrap();
    assert!(error.to_string().contains("none.csv cannot be read"), "{error}");
}

#[test]
fn what_a_deck_names_wrongly_is_said_with_its_place() {
    let (folder, mut model) = (tempfile::tempdir().unwrap(), model());
    let mut said = |name: &str, parameters: &str| {
        let (made, mut report) = make(name, parameters, &mut model, folder.path());
        let initialised = made.and_then(|mut process| process.initialize(&mut model));
        report.absorb(initialised);
        report.diagnostics().iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    let variable = said(
        "json_output_process",
        r#"{"model_part_name": "Structure", "output_file_name": "a.json", "output_variables": ["DISPLACMENT"]}"#,
    );
    assert!(variable.contains("deck.json:1:") && variable.contains("did you mean \"DISPLACEMENT\""), "{variable}");
    let stress = said(
        "vtk_output_process",
        r#"{"model_part_name": "Structure", "gauss_point_variables_in_elements": ["OUTPUT_TEST_VECTR"]}"#,
    );
    assert!(stress.contains("OUTPUT_TEST_VECTOR"), "{stress}");
    let control = said("vtk_output_process", r#"{"model_part_name": "Structure", "output_control_type": "stp"}"#);
    assert!(control.contains("use \"step\" or \"time\""), "{control}");
    let part = said("vtk_output_process", r#"{"model_part_name": "Structure.Edg"}"#);
    assert!(part.contains("Structure.Edge") && part.contains("deck.json:1:"), "{part}");
    let file =
        said("from_json_check_result_process", r#"{"model_part_name": "Structure", "input_file_name": "no.json"}"#);
    assert!(file.contains("error[missing-file] deck.json:1:"), "{file}");
    assert!(said("vtk_output_process", "{}").contains("model_part_name"));
}

#[test]
fn a_disk_that_refuses_is_an_error_of_the_system() {
    let (folder, mut model) = (tempfile::tempdir().unwrap(), model());
    std::fs::write(folder.path().join("out"), "a file where a folder should be").unwrap();
    let parameters = r#"{"model_part_name": "Structure", "output_path": "out"}"#;
    let mut process = make("vtk_output_process", parameters, &mut model, folder.path()).0.unwrap();
    let error = run(process.as_mut(), &mut model, 1, 0.1).unwrap_err();
    assert!(matches!(error, Error::System(_)), "{error}");
}
