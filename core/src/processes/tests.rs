use super::*;
use crate::assembly::System;
use crate::diagnostics::{Report, Result};
use crate::geometry::Shape;
use crate::model::{DofOwners, EntityKind, EntityRole, Model, ModelPart, Nodes, ScalarVariable, SubPart, named};
use crate::parameters::{Defaults, Document, Settings};
use crate::register_variable;
use crate::registry::{self, Entry};

register_variable! {
    kind TEST_PRESSURE: Scalar = "Load of the tests.";
    kind TEST_LOAD: Vector3 = "Load of the tests.";
}

static LINE: EntityKind = EntityKind {
    cell: Some(Shape::Line2),
    space: 2,
    ..EntityKind::new(EntityRole::Condition, Entry::new("TestLine2D2N", file!(), line!()))
};

/// Three nodes on the x axis at 0, 1, 3; two line conditions between them; part "Edge" with the last two nodes.
fn model() -> Model {
    let mut part = ModelPart::new("Structure");
    part.nodes = Nodes::new(vec![4, 5, 9], vec![[0.0; 3], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]]);
    part.nodes.history.add_named("DISPLACEMENT", 3);
    part.nodes.history.add_named("TEST_PRESSURE", 1);
    part.info.domain_size = 2;
    part.conditions.push(1, &LINE, 0, &[0, 1]);
    part.conditions.push(2, &LINE, 0, &[1, 2]);
    part.conditions.finish();
    let edge = SubPart { nodes: vec![1, 2], conditions: vec![1], ..SubPart::new("Edge") };
    part.tree.nodes = vec![0, 1, 2];
    part.tree.conditions = vec![0, 1];
    part.tree.children.insert("Edge".into(), edge);
    let mut model = Model::default();
    model.add(part);
    model
}

/// The displacements of [`model`] are unknowns.
fn system() -> System {
    let mut system = System::default();
    let displacement = |name| DofOwners::of_nodes(scalar(name), vec![0, 1, 2]);
    let part = &model().parts["Structure"];
    system.dofs.number(part, &["DISPLACEMENT_X", "DISPLACEMENT_Y"].map(displacement), &[]);
    system
}

fn scalar(name: &str) -> ScalarVariable {
    match named(name).unwrap() {
        crate::model::Named::Component(variable) => variable,
        crate::model::Named::Whole(column, _) => ScalarVariable { column, component: None },
    }
}

fn make(module: &str, parameters: &str, model: &mut Model) -> Result<Box<dyn Process>> {
    let parameters = Document::from_str(parameters, "deck.json").unwrap().root;
    let entry = registry::find::<ProcessEntry>(module).unwrap();
    let folder = std::path::Path::new("");
    let report = &mut Report::new();
    (entry.build)(&mut ProcessRequest { entry, parameters: &parameters, model, folder, results: folder, report })
}

fn refused(module: &str, parameters: &str) -> String {
    let mut model = model();
    let run = |model: &mut Model| {
        let mut process = make(module, parameters, model)?;
        process.initialize(model)?;
        process.check(model, &system(), &mut Report::new())?;
        process.before_loop(model)?;
        step(&mut *process, model, 0.1)
    };
    run(&mut model).unwrap_err().to_string()
}

fn part(model: &mut Model) -> &mut ModelPart {
    model.parts.get_mut("Structure").unwrap()
}

fn step(process: &mut dyn Process, model: &mut Model, time: f64) -> Result<()> {
    part(model).info.time = time;
    process.begin_step(model)
}

fn value(model: &mut Model, name: &str, node: usize) -> f64 {
    part(model).nodes.history.scalar(scalar(name), node).unwrap()
}

fn fixed(model: &mut Model, name: &str, node: u32) -> bool {
    part(model).nodes.is_fixed(scalar(name), node)
}

#[test]
fn a_scalar_is_fixed_and_set_in_the_step_and_released_after() {
    let mut model = model();
    let text = r#"{"model_part_name": "Structure.Edge", "variable_name": "DISPLACEMENT_X", "value": "2*t+X", "interval": [0.0, 0.2]}"#;
    let mut process = make("assign_scalar_variable_process", text, &mut model).unwrap();
    process.initialize(&mut model).unwrap();
    process.before_loop(&mut model).unwrap();
    assert_eq!([0, 1, 2].map(|n| value(&mut model, "DISPLACEMENT_X", n)), [0.0, 1.0, 3.0]);
    assert_eq!([0, 1, 2].map(|n| fixed(&mut model, "DISPLACEMENT_X", n)), [false, true, true]);
    step(&mut *process, &mut model, 0.1).unwrap();
    assert_eq!(value(&mut model, "DISPLACEMENT_X", 2), 3.2);
    process.end_step(&mut model, &system()).unwrap();
    assert!(!fixed(&mut model, "DISPLACEMENT_X", 2));
    // the end point is outside when the interval begins at 0; the value stays as the start of the next step
    step(&mut *process, &mut model, 0.2).unwrap();
    assert!(!fixed(&mut model, "DISPLACEMENT_X", 2));
    assert_eq!(value(&mut model, "DISPLACEMENT_X", 2), 3.2);
}

#[test]
fn what_is_fixed_before_the_loop_stays_fixed_through_the_first_step() {
    let mut model = model();
    let text =
        r#"{"model_part_name": "Structure", "variable_name": "DISPLACEMENT_Y", "value": 1.5, "interval": [0.0, 0.05]}"#;
    let mut process = make("assign_scalar_variable_process", text, &mut model).unwrap();
    process.before_loop(&mut model).unwrap();
    step(&mut *process, &mut model, 0.1).unwrap();
    assert!(fixed(&mut model, "DISPLACEMENT_Y", 0));
    assert_eq!(value(&mut model, "DISPLACEMENT_Y", 0), 1.5);
    process.end_step(&mut model, &system()).unwrap();
    assert!(!fixed(&mut model, "DISPLACEMENT_Y", 0));
}

#[test]
fn a_retried_shorter_step_acts_at_its_own_time() {
    let mut model = model();
    let text = r#"{"model_part_name": "Structure", "variable_name": "DISPLACEMENT_Y", "value": "t", "interval": [1.0, "End"]}"#;
    let mut process = make("assign_scalar_variable_process", text, &mut model).unwrap();
    let saved = part(&mut model).nodes.fixities.clone();
    step(&mut *process, &mut model, 1.0).unwrap();
    assert!(fixed(&mut model, "DISPLACEMENT_Y", 0));
    part(&mut model).nodes.fixities = saved;
    // another process holds the unknown now; this one must not release it
    part(&mut model).nodes.set_fixed(scalar("DISPLACEMENT_Y"), &[0], true);
    step(&mut *process, &mut model, 0.5).unwrap();
    process.end_step(&mut model, &system()).unwrap();
    assert!(fixed(&mut model, "DISPLACEMENT_Y", 0));
}

#[test]
fn a_vector_leaves_null_components_alone() {
    let mut model = model();
    let text = r#"{"model_part_name": "Structure", "variable_name": "DISPLACEMENT", "value": [1.0, null, "t"],
        "constrained": [true, true, false], "interval": [0.0, "End"]}"#;
    let mut process = make("assign_vector_variable_process", text, &mut model).unwrap();
    step(&mut *process, &mut model, 0.5).unwrap();
    let of = |model: &mut Model, c: &str| (value(model, c, 1), fixed(model, c, 1));
    assert_eq!(of(&mut model, "DISPLACEMENT_X"), (1.0, true));
    assert_eq!(of(&mut model, "DISPLACEMENT_Y"), (0.0, false));
    assert_eq!(of(&mut model, "DISPLACEMENT_Z"), (0.5, false));
    for (constrained, expected) in
        [("", true), (r#", "constrained": true"#, true), (r#", "constrained": false"#, false)]
    {
        let mut model = self::model();
        let text = format!(
            r#"{{"model_part_name": "Structure", "variable_name": "DISPLACEMENT", "value": [0, 0, 0]{constrained}}}"#
        );
        let mut process = make("AssignVectorVariableProcess", &text, &mut model).unwrap();
        step(&mut *process, &mut model, 0.5).unwrap();
        assert_eq!(
            ["DISPLACEMENT_X", "DISPLACEMENT_Y", "DISPLACEMENT_Z"].map(|c| fixed(&mut model, c, 0)),
            [expected; 3]
        );
    }
}

#[test]
fn directions_are_made_unit_vectors_unless_they_hold_functions() {
    let run = |modulus: &str, direction: &str| {
        let mut model = model();
        let text = format!(
            r#"{{"model_part_name": "Structure", "variable_name": "DISPLACEMENT", "modulus": {modulus}, "direction": {direction}}}"#
        );
        let mut process = make("assign_vector_by_direction_process", &text, &mut model).unwrap();
        step(&mut *process, &mut model, 0.5).unwrap();
        ["DISPLACEMENT_X", "DISPLACEMENT_Y", "DISPLACEMENT_Z"].map(|c| value(&mut model, c, 1))
    };
    // in the plane the third entry neither counts for the length nor is set
    assert_eq!(run("10", "[3.0, 4.0, 12.0]"), [6.0, 8.0, 0.0]);
    assert_eq!(run("\"2*t\"", "[0.0, -2.0, 0.0]"), [0.0, -1.0, 0.0]);
    assert_eq!(run("3", "[2.0, \"x+t\", 0.0]"), [6.0, 4.5, 0.0]);
    // lines along +x have their normal along −y
    assert_eq!(run("3", "\"automatic_outwards_normal\""), [0.0, -3.0, 0.0]);
    assert_eq!(run("3", "\"automatic_inwards_normal\""), [0.0, 3.0, 0.0]);
}

#[test]
fn fixing_leaves_values_alone() {
    let mut model = model();
    part(&mut model).nodes.history.get_mut("DISPLACEMENT").unwrap().levels[0][0] = 7.0;
    let text =
        r#"{"model_part_name": "Structure", "variable_name": "DISPLACEMENT", "constrained": [true, false, true]}"#;
    let mut process = make("fix_vector_variable_process", text, &mut model).unwrap();
    process.before_loop(&mut model).unwrap();
    assert!(!fixed(&mut model, "DISPLACEMENT_X", 0));
    step(&mut *process, &mut model, 0.5).unwrap();
    assert!(fixed(&mut model, "DISPLACEMENT_X", 0) && !fixed(&mut model, "DISPLACEMENT_Y", 0));
    assert_eq!(value(&mut model, "DISPLACEMENT_X", 0), 7.0);
    process.end_step(&mut model, &system()).unwrap();
    assert!(!fixed(&mut model, "DISPLACEMENT_X", 0));
    let text = r#"{"model_part_name": "Structure", "variable_name": "DISPLACEMENT_X"}"#;
    let mut process = make("fix_scalar_variable_process", text, &mut model).unwrap();
    step(&mut *process, &mut model, 0.5).unwrap();
    assert!(fixed(&mut model, "DISPLACEMENT_X", 0));
}

#[test]
fn conditions_see_functions_at_their_present_and_initial_centre() {
    let mut model = model();
    part(&mut model).nodes.current[2] = [5.0, 2.0, 0.0];
    let text = r#"{"model_part_name": "Structure.Edge", "variable_name": "TEST_PRESSURE", "value": "10*x + y*t + X/sqrt(X*X+Y*Y)", "interval": [0.0, 0.3]}"#;
    let mut process = make("assign_scalar_variable_to_conditions_process", text, &mut model).unwrap();
    process.before_loop(&mut model).unwrap();
    assert!(!part(&mut model).conditions.data.has("TEST_PRESSURE"));
    step(&mut *process, &mut model, 0.25).unwrap();
    let data = |model: &mut Model| part(model).conditions.data.get("TEST_PRESSURE").unwrap().levels[0].clone();
    assert_eq!(*data(&mut model), [0.0, 31.25]);
    process.end_step(&mut model, &system()).unwrap();
    step(&mut *process, &mut model, 0.35).unwrap();
    assert_eq!(*data(&mut model), [0.0, 31.25]);
}

#[test]
fn vectors_go_to_the_listed_entities() {
    let mut model = model();
    let text = r#"{"model_part_name": "Structure", "variable_name": "TEST_LOAD", "value": [1, null, "t"], "entities": ["conditions", "nodes"]}"#;
    let mut process = make("assign_vector_variable_to_entities_process", text, &mut model).unwrap();
    step(&mut *process, &mut model, 0.5).unwrap();
    assert_eq!(part(&mut model).conditions.data.get("TEST_LOAD").unwrap().vector(0, 1), [1.0, 0.0, 0.5]);
    assert_eq!(part(&mut model).nodes.values.get("TEST_LOAD").unwrap().vector(0, 2), [1.0, 0.0, 0.5]);
    let text = r#"{"model_part_name": "Structure", "variable_name": "TEST_LOAD", "modulus": "-1.0*t", "direction": [0, 0, 2]}"#;
    let mut process = make("assign_vector_by_direction_to_condition_process", text, &mut model).unwrap();
    step(&mut *process, &mut model, 0.5).unwrap();
    assert_eq!(part(&mut model).conditions.data.get("TEST_LOAD").unwrap().vector(0, 0), [0.0, 0.0, -0.5]);
}

#[test]
fn flags_are_set_before_the_loop_too() {
    let mut model = model();
    let text = r#"{"model_part_name": "Structure.Edge", "flag_name": "ACTIVE", "value": false, "entities": ["conditions", "nodes"]}"#;
    let mut process = make("assign_flag_process", text, &mut model).unwrap();
    process.before_loop(&mut model).unwrap();
    assert_eq!([0, 1].map(|i| part(&mut model).conditions.flags.get("ACTIVE", i)), [None, Some(false)]);
    assert_eq!([0, 1].map(|i| part(&mut model).nodes.flags.get("ACTIVE", i)), [None, Some(false)]);
}

#[test]
fn functions_are_read_in_local_axes() {
    let mut model = model();
    let text = r#"{"model_part_name": "Structure", "variable_name": "DISPLACEMENT_X", "value": "x+100*y+10000*X",
        "local_axes": {"origin": [1, 0, 0], "axes": [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]}}"#;
    let mut process = make("assign_scalar_variable_process", text, &mut model).unwrap();
    step(&mut *process, &mut model, 0.5).unwrap();
    assert_eq!(value(&mut model, "DISPLACEMENT_X", 2), -200.0);
    let said = refused("assign_scalar_variable_process", &text.replace("\"origin\": [1, 0, 0], ", ""));
    assert!(
        said.starts_with("error[invalid-local-axes] deck.json:2:9: local axes need \"origin\" and \"axes\""),
        "{said}"
    );
}

#[test]
fn a_table_is_read_beside_the_deck() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("load.csv"), "time; a; value\n0.0; x; 1.0\n\n1.0; x; 3.0\n2.0; x; N/A\n")
        .unwrap();
    let deck = folder.path().join("deck.json");
    let read = |text: &str| ScalarValue::from_node(&Document::from_str(text, &deck).unwrap().root);
    let text = r#"{"name": "csv_table", "filename": "load.csv", "delimiter": ";", "skiprows": 1, "second_column_id": 2, "na_replace": 5.0}"#;
    let value = read(text).unwrap();
    let at = |time: f64| value.value(&crate::parameters::SpaceTime { time, ..Default::default() });
    assert_eq!([-1.0, 0.5, 1.5, 3.0].map(at), [-1.0, 2.0, 4.0, 7.0]);
    let said = read(r#"{"filename": "load.csv"}"#).unwrap_err().to_string();
    assert!(said.contains("load.csv:1: the row has 1 columns, wanted are 0 and 1"), "{said}");
    let said = read(r#"{"filename": "lost.csv"}"#).unwrap_err().to_string();
    assert!(said.starts_with("error[unreadable-file]") && said.contains("deck.json:1:2"), "{said}");
    assert!(
        read("[1]")
            .unwrap_err()
            .to_string()
            .contains("a value must be a number, a function or a table, found an array")
    );
}

#[test]
fn mistakes_are_named_with_their_place() {
    let scalar = "assign_scalar_variable_process";
    let base = r#""model_part_name": "Structure", "variable_name": "DISPLACEMENT_X""#;
    let said = refused(scalar, &format!("{{{base},\n \"mesh_id\": 0}}"));
    assert!(
        said.starts_with(
            "error[unknown-key] deck.json:2:2: \"mesh_id\" is not a setting of assign_scalar_variable_process"
        ),
        "{said}"
    );
    let said = refused(scalar, &format!("{{{base},\n \"value\": \"2*q\"}}"));
    assert!(said.starts_with("error[invalid-expression] deck.json:2:14: in \"2*q\": unknown name \"q\""), "{said}");
    let said = refused(scalar, &format!("{{{base},\n \"value\": \"1/(t-0.1)\"}}"));
    assert_eq!(
        said,
        "error[not-finite] deck.json:1:2: assign_scalar_variable_process gives inf for DISPLACEMENT_X at node 4 at time 0.1\n    \
         check the function there, e.g. for a division by zero"
    );
    let said = refused(scalar, "{\"model_part_name\": \"Structure.Edgy\", \"variable_name\": \"DISPLACEMENT_X\"}");
    assert!(said.starts_with("error[unknown-model-part] deck.json:1:2: "), "{said}");
    assert!(said.contains("Structure.Edge"), "{said}");
    let said = refused(scalar, "{\"model_part_name\": \"Structure\", \"variable_name\": \"DISPLACEMNT_X\"}");
    assert!(
        said.starts_with("error[unknown-variable] deck.json:1:34: there is no variable \"DISPLACEMNT_X\""),
        "{said}"
    );
    assert!(said.contains("did you mean \"DISPLACEMENT"), "{said}");
    let said = refused(scalar, "{\"model_part_name\": \"Structure\", \"variable_name\": \"DISPLACEMENT\"}");
    assert!(said.contains("DISPLACEMENT is not one number"), "{said}");
    let said = refused(scalar, "{\"model_part_name\": \"Structure\", \"variable_name\": \"VELOCITY_X\"}");
    assert!(said.starts_with("error[variable-not-in-model] deck.json:1:2: "), "{said}");
    assert!(refused(scalar, "{\"variable_name\": \"DISPLACEMENT_X\"}").contains("\"model_part_name\" of"));
    let by_direction = |direction: &str| {
        let text = format!(
            "{{\"model_part_name\": \"Structure\", \"variable_name\": \"DISPLACEMENT\", \"modulus\": 1,\n\"direction\": {direction}}}"
        );
        refused("assign_vector_by_direction_process", &text)
    };
    assert!(
        by_direction("[0, 0, 0]").starts_with("error[invalid-direction] deck.json:2:14: the direction has no length")
    );
    assert!(by_direction("[0, 0, 1]").starts_with("error[invalid-direction]"));
    assert!(by_direction("\"up\"").contains("a direction must be three numbers or functions, found \"up\""));
    let flag = r#"{"model_part_name": "Structure", "flag_name": "ACTIV", "entities": ["nodes"]}"#;
    assert!(refused("assign_flag_process", flag).contains("did you mean \"ACTIVE\"?"));
    let flag = r#"{"model_part_name": "Structure", "flag_name": "ACTIVE", "entities": ["node"]}"#;
    assert!(refused("assign_flag_process", flag).contains("did you mean \"nodes\"?"));
}

#[test]
fn every_setting_of_every_registered_object_is_documented() {
    for (_, entry) in registry::entries().into_iter().filter(|(_, e)| !e.defaults.is_empty()) {
        let defaults = Defaults::parse(entry.name, entry.defaults).unwrap();
        assert!(!defaults.description().is_empty(), "{entry:?} has no description above its brace");
        for key in defaults.entries() {
            let documented = !key.description.is_empty() || key.without_effect.is_some();
            assert!(documented, "{entry:?}: {} has no comment", key.path);
            assert!(!key.description.starts_with("without effect"), "{entry:?}: {} is to be listed", key.path);
        }
    }
}

#[test]
fn the_decks_of_the_reference_program_fit() {
    let default = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared").to_owned();
    let decks = std::path::PathBuf::from(std::env::var("ZELUS_SHARED").unwrap_or(default)).join("decks");
    let Ok(groups) = std::fs::read_dir(&decks) else {
        println!("skipped: {} is absent", decks.display());
        return;
    };
    let mut checked = 0;
    for deck in groups.flatten().flat_map(|group| std::fs::read_dir(group.path()).into_iter().flatten().flatten()) {
        let Ok(document) = Document::read(deck.path().join("ProjectParameters.json")) else { continue };
        let lists = document.root.get("processes").and_then(|p| p.as_object());
        for item in lists.into_iter().flat_map(|l| l.iter()).flat_map(|list| list.node.array().unwrap()) {
            let module = item.get("python_module").unwrap().str().unwrap();
            let ours = |e: &&ProcessEntry| e.file.contains("core/src/processes") && !e.file.contains("/output/");
            let Some(entry) = registry::find::<ProcessEntry>(module).filter(ours) else {
                continue;
            };
            let defaults = Defaults::parse(entry.name, entry.defaults).unwrap();
            let parameters = item.get("Parameters").unwrap();
            let (settings, warnings) = Settings::check(parameters, &defaults).unwrap_or_else(|e| panic!("{e}"));
            assert!(warnings.is_empty());
            if let Ok(interval) = settings.get("interval") {
                crate::parameters::Interval::from_node(interval).unwrap();
            }
            for key in ["value", "modulus"] {
                let Ok(node) = settings.get(key) else { continue };
                for value in node.as_array().unwrap_or(std::slice::from_ref(node)).iter().filter(|v| !v.is_null()) {
                    ScalarValue::from_node(value).unwrap_or_else(|e| panic!("{e}"));
                }
            }
            checked += 1;
        }
    }
    assert!(checked > 100, "{checked}");
    println!("{checked} process entries fit");
}

#[test]
fn fixing_what_is_no_unknown_is_a_warning() {
    let (mut model, mut warnings) = (model(), Report::new());
    let parameters = "{\"model_part_name\": \"Structure\", \"variable_name\": \"TEST_PRESSURE\"}";
    let process = make("assign_scalar_variable_process", parameters, &mut model).unwrap();
    process.check(&model, &system(), &mut warnings).unwrap();
    let said = warnings.diagnostics()[0].to_string();
    let expected = "warning[not-an-unknown] deck.json:1:2: assign_scalar_variable_process fixes TEST_PRESSURE";
    assert!(said.starts_with(expected), "{said}");
}

#[test]
fn checks_of_nodes_count_decimals() {
    let mut model = model();
    let prescribe =
        r#"{"model_part_name": "Structure", "variable_name": "DISPLACEMENT", "value": ["0.1*X+t", 0.02, null]}"#;
    let mut process = make("assign_vector_variable_process", prescribe, &mut model).unwrap();
    step(&mut *process, &mut model, 0.5).unwrap();
    let mut check = |parameters: &str, module: &str| {
        let mut process = make(module, parameters, &mut model).unwrap();
        process.initialize(&mut model).unwrap();
        process.end_step(&mut model, &system()).map_err(|e| e.to_string())
    };
    let vector = "check_vector_components_to_nodes_process";
    let base = r#""model_part_name": "Structure", "variable_name": "DISPLACEMENT""#;
    check(&format!("{{{base}, \"value\": [\"0.1*X+t\", null, null], \"tolerance_rank\": 14}}"), vector).unwrap();
    check(&format!("{{{base}, \"value\": [null, 0.0204, null]}}"), vector).unwrap();
    check(&format!("{{{base}, \"value\": [null, 1.0, null], \"interval\": [0.0, 0.4]}}"), vector).unwrap();
    let said = check(
        &format!("{{{base}_Y\", \"value\": 0.0206}}").replace("DISPLACEMENT\"_Y", "DISPLACEMENT_Y"),
        "check_scalar_to_nodes_process",
    );
    let said = said.unwrap_err();
    assert!(said.contains("node 4: DISPLACEMENT_Y is 2e-2, expected 2.06e-2"), "{said}");
}

/// Three nodes at x = 0, 1, 3; sites at x = 0.4 and at node 9 (x = 3): the first two nodes are nearer to the first.
#[test]
fn sites_of_a_file_give_their_series_to_what_is_nearest() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        serde_json::to_string(path.to_str().unwrap()).unwrap()
    };
    let json = write(
        "sites.json",
        r#"{"TIME": [0.0, 1.0], "1": {"COORDINATES": [0.4, 0.0, 0.0], "VALUES": {"TEST_PRESSURE": [1.0, 3.0]}},
        "2": {"COORDINATES": [3.0, 0.0, 0.0], "VALUES": {"TEST_PRESSURE": [-1.0, -1.0]}}}"#,
    );
    let text = write("sites.txt", "Time\t4\t9\n0.0\t1.0\t-1.0\n\n1.0\t3.0\t-1.0\n");
    let parameters = |file: &str, more: &str| {
        format!(r#"{{"model_part_name": "Structure", "variable_name": "TEST_PRESSURE", "file": {file} {more}}}"#)
    };
    let module = |what: &str| format!("assign_scalar_input_to_{what}_process");
    for file in [&json, &text] {
        let mut model = model();
        let given = parameters(file, r#", "historical": true"#);
        let mut process = make(&module("nodes"), &given, &mut model).unwrap();
        process.initialize(&mut model).unwrap();
        step(&mut *process, &mut model, 0.5).unwrap();
        assert_eq!([0, 1, 2].map(|node| value(&mut model, "TEST_PRESSURE", node)), [2.0, 2.0, -1.0]);
    }
    let mut model = model();
    let given = parameters(&json, r#", "entities": ["conditions"], "interval": [0.0, 2.0]"#);
    let mut process = make(&module("entities"), &given, &mut model).unwrap();
    process.initialize(&mut model).unwrap();
    for time in [0.25, 3.0] {
        step(&mut *process, &mut model, time).unwrap();
        let field = part(&mut model).conditions.data.get("TEST_PRESSURE").unwrap();
        assert_eq!(*field.levels[0], [1.5, -1.0], "centres at 0.5 and 2; the last value stays");
    }
    let wrong = [
        (write("a.txt", "Time\t4\n0.0\n"), "1 numbers for a time and 1 sites"),
        (write("b.txt", "0.0 1.0\n"), "does not name sites"),
        (write("c.txt", "Time\t77\n0.0\t1.0\n"), "names 77"),
        (write("d.csv", ""), "neither JSON nor text"),
        (write("e.json", r#"{"TIME": []}"#), "no site"),
    ];
    for (file, words) in wrong {
        let said = refused(&module("nodes"), &parameters(&file, ""));
        assert!(said.contains(words), "no {words:?} in {said}");
    }
}
