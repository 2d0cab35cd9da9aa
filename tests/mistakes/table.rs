//! The mistakes: the change of a good deck, the time of the message, and its words.

use serde_json::{Value, json};

use crate::blocks_of_case::raised;

/// The files of a deck.
pub struct Files {
    pub deck: Value,
    pub materials: Value,
    pub mesh: String,
}

/// When a mistake is told.
#[derive(PartialEq, Eq)]
pub enum Told {
    /// By `zelus check`, and before the first step of a run.
    Before,
    /// By the run only.
    Run,
}

/// A deck with one mistake.
pub struct Mistake {
    pub what: &'static str,
    pub case: &'static str,
    pub make: fn(&mut Files),
    /// Exit code of a run.
    pub exit: i32,
    pub told: Told,
    pub code: &'static str,
    /// Words of the message: its subject.
    pub names: &'static str,
}

pub fn load(deck: &mut Value) -> &mut Value {
    &mut deck["processes"]["loads_process_list"][0]["Parameters"]
}

pub fn contact(deck: &mut Value) -> &mut Value {
    &mut deck["processes"]["contact_process_list"][0]["Parameters"]
}

/// The supports of the sides.
pub fn support(deck: &mut Value) -> &mut Value {
    &mut deck["processes"]["constraints_process_list"][1]["Parameters"]
}

/// The upper block is moved by its top and not loaded.
fn held_from_above(files: &mut Files, motion: &str) {
    let processes = &mut files.deck["processes"];
    processes["loads_process_list"] = json!([]);
    let supports = processes["constraints_process_list"].as_array_mut().expect("a list");
    let mut top = supports[0].clone();
    top["Parameters"]["model_part_name"] = json!("Structure.Top");
    top["Parameters"]["value"] = json!([null, motion, null]);
    supports.push(top);
}

fn swap(text: &mut String, find: &str, with: &str) {
    assert!(text.contains(find), "the mesh does not have {find:?}");
    *text = text.replacen(find, with, 1);
}

/// Lists an entity in a sub model part.
fn list(mesh: &mut String, part: &str, kind: &str, id: usize) {
    let at = mesh.find(&format!("Begin SubModelPart {part}\n")).expect("the part");
    let begin = format!("Begin SubModelPart{kind}\n");
    let at = at + mesh[at..].find(&begin).expect("its list") + begin.len();
    mesh.insert_str(at, &format!("{id}\n"));
}

pub const PRESSED: &str = "contact_2d/matching";
pub const SLIDING: &str = "contact_2d/friction_slide";

const CONSTRAINED: &str = "mpc/pressed_and_opened";

pub const MISTAKES: &[Mistake] = &[
    Mistake {
        what: "one load by two processes",
        case: PRESSED,
        make: |Files { deck, .. }| {
            let loads = deck["processes"]["loads_process_list"].as_array_mut().expect("a list");
            let mut other = loads[0].clone();
            other["Parameters"]["direction"] = json!([1.0, 0.0, 0.0]);
            other["Parameters"]["interval"] = json!([0.5, "End"]);
            loads.push(other);
        },
        exit: 0,
        told: Told::Before,
        code: "load-given-twice",
        names: "LINE_LOAD of 3 conditions is given by",
    },
    Mistake {
        what: "a load on nodes that a support holds",
        case: PRESSED,
        make: |Files { deck, .. }| {
            let top = json!({"python_module": "assign_vector_variable_process", "Parameters": {
                "model_part_name": "Structure.Top", "variable_name": "DISPLACEMENT", "value": [0.0, 0.0, 0.0]}});
            deck["processes"]["constraints_process_list"].as_array_mut().expect("supports").push(top);
        },
        exit: 0,
        told: Told::Before,
        code: "load-on-support",
        names: "on Structure.Top acts on supports alone",
    },
    Mistake {
        what: "a pair of faces of one body",
        case: PRESSED,
        make: |Files { deck, .. }| {
            contact(deck)["contact_model_part"] = json!({"0": ["Slave", "Top"]});
            contact(deck)["assume_master_slave"] = json!({"0": ["Slave"]});
        },
        exit: 2,
        told: Told::Before,
        code: "one-body",
        names: "both sides are faces of one body, that of node 13, and no slave node has the master before it",
    },
    Mistake {
        what: "a surface load on lines",
        case: PRESSED,
        make: |Files { deck, .. }| load(deck)["variable_name"] = json!("SURFACE_LOAD"),
        exit: 0,
        told: Told::Before,
        code: "acts-on-nothing",
        names: "no condition of Structure.Top takes SURFACE_LOAD",
    },
    Mistake {
        what: "a point load on lines",
        case: PRESSED,
        make: |Files { deck, .. }| load(deck)["variable_name"] = json!("POINT_LOAD"),
        exit: 0,
        told: Told::Before,
        code: "acts-on-nothing",
        names: "POINT_LOAD",
    },
    Mistake {
        what: "a load out of the plane",
        case: PRESSED,
        make: |Files { deck, .. }| load(deck)["direction"] = json!([0.0, 0.0, 1.0]),
        exit: 0,
        told: Told::Before,
        code: "acts-on-nothing",
        names: "out of the plane",
    },
    Mistake {
        what: "a load on a part of nodes",
        case: "contact_2d/parts_of_nodes",
        make: |Files { deck, .. }| load(deck)["model_part_name"] = json!("Structure.Bottom"),
        exit: 0,
        told: Told::Before,
        code: "acts-on-nothing",
        names: "has no conditions",
    },
    Mistake {
        what: "an interval that ends before it begins",
        case: PRESSED,
        make: |Files { deck, .. }| load(deck)["interval"] = json!([1.0, 0.0]),
        exit: 0,
        told: Told::Before,
        code: "interval-reversed",
        names: "[1.0,0.0]",
    },
    Mistake {
        what: "an interval after the run",
        case: PRESSED,
        make: |Files { deck, .. }| load(deck)["interval"] = json!([5.0, 6.0]),
        exit: 0,
        told: Told::Before,
        code: "interval-outside",
        names: "0 to 1",
    },
    Mistake {
        what: "an interval from zero to the end of the run",
        case: PRESSED,
        make: |Files { deck, .. }| {
            deck["solver_settings"]["time_stepping"] = json!({"time_step": 0.5});
            load(deck)["interval"] = json!([0.0, 1.0]);
        },
        exit: 0,
        told: Told::Before,
        code: "interval-end",
        names: "leaves out the last step, which ends at 1",
    },
    Mistake {
        what: "contact settings without contact",
        case: PRESSED,
        make: |Files { deck, .. }| deck["processes"]["contact_process_list"] = json!([]),
        exit: 4,
        told: Told::Before,
        code: "settings-without-process",
        names: "contact_settings",
    },
    Mistake {
        what: "friction below zero in the materials",
        case: SLIDING,
        make: |Files { deck, materials, .. }| {
            contact(deck).as_object_mut().expect("settings").remove("friction_coefficients");
            for material in materials["properties"].as_array_mut().expect("a list") {
                material["Material"]["Variables"]["FRICTION_COEFFICIENT"] = json!(-0.3);
            }
        },
        exit: 2,
        told: Told::Before,
        code: "negative-friction",
        names: "-0.3",
    },
    Mistake {
        what: "friction without a coefficient",
        case: SLIDING,
        make: |Files { deck, .. }| {
            contact(deck).as_object_mut().expect("settings").remove("friction_coefficients");
        },
        exit: 0,
        told: Told::Before,
        code: "no-friction",
        names: "FRICTION_COEFFICIENT",
    },
    Mistake {
        what: "a coefficient for a pair that is not there",
        case: SLIDING,
        make: |Files { deck, .. }| contact(deck)["friction_coefficients"] = json!({"9": 0.3}),
        exit: 0,
        told: Told::Before,
        code: "no-friction",
        names: "FRICTION_COEFFICIENT",
    },
    Mistake {
        what: "slaves of a pair that is not there",
        case: PRESSED,
        make: |Files { deck, .. }| contact(deck)["assume_master_slave"] = json!({"7": ["Slave"]}),
        exit: 0,
        told: Told::Before,
        code: "slaves-without-pair",
        names: "\"7\"",
    },
    Mistake {
        what: "one slave side in two pairs",
        case: PRESSED,
        make: |Files { deck, .. }| {
            contact(deck)["contact_model_part"] = json!({"0": ["Interface"], "1": ["Interface"]});
            contact(deck)["assume_master_slave"] = json!({"0": ["Slave"], "1": ["Slave"]});
        },
        exit: 0,
        told: Told::Before,
        code: "slave-in-two-pairs",
        names: "pair \"0\" and of pair \"1\"",
    },
    Mistake {
        what: "two materials with one id",
        case: PRESSED,
        make: |Files { materials, .. }| {
            for material in materials["properties"].as_array_mut().expect("a list") {
                material["properties_id"] = json!(1);
            }
        },
        exit: 2,
        told: Told::Before,
        code: "repeated-properties",
        names: "properties 1",
    },
    Mistake {
        what: "a tolerance below zero",
        case: PRESSED,
        make: |Files { deck, .. }| deck["solver_settings"]["residual_relative_tolerance"] = json!(-1e-4),
        exit: 2,
        told: Told::Before,
        code: "invalid-tolerance",
        names: "nothing is below it",
    },
    Mistake {
        what: "a tolerance that everything meets",
        case: PRESSED,
        make: |Files { deck, .. }| {
            deck["solver_settings"]["contact_settings"]["contact_residual_relative_tolerance"] = json!(2)
        },
        exit: 2,
        told: Told::Before,
        code: "invalid-tolerance",
        names: "contact_residual_relative_tolerance",
    },
    Mistake {
        what: "a key beside the parameters of a process",
        case: PRESSED,
        make: |Files { deck, .. }| deck["processes"]["loads_process_list"][0]["Paramters"] = json!({}),
        exit: 0,
        told: Told::Before,
        code: "unknown-key-ignored",
        names: "Parameters",
    },
    Mistake {
        what: "a key of the problem data",
        case: PRESSED,
        make: |Files { deck, .. }| deck["problem_data"]["end_tme"] = json!(3),
        exit: 0,
        told: Told::Before,
        code: "unknown-key-ignored",
        names: "end_time",
    },
    Mistake {
        what: "a key of the mesh",
        case: PRESSED,
        make: |Files { deck, .. }| deck["solver_settings"]["model_import_settings"]["filename"] = json!("x"),
        exit: 0,
        told: Told::Before,
        code: "unknown-key-ignored",
        names: "filename",
    },
    Mistake {
        what: "a key of the linear solver",
        case: PRESSED,
        make: |Files { deck, .. }| {
            let settings = json!({"solver_type": "skyline_lu_factorization", "tollerance": 1e-9});
            deck["solver_settings"]["linear_solver_settings"] = settings;
        },
        exit: 0,
        told: Told::Before,
        code: "unknown-key-ignored",
        names: "tolerance",
    },
    Mistake {
        what: "a load out of the plane, as a function",
        case: PRESSED,
        make: |Files { deck, .. }| {
            load(deck)["direction"] = json!([0.0, 0.0, 1.0]);
            load(deck)["modulus"] = json!("1e6*t");
        },
        exit: 0,
        told: Told::Before,
        code: "acts-on-nothing",
        names: "out of the plane",
    },
    Mistake {
        what: "a motion out of the plane",
        case: PRESSED,
        make: |Files { deck, .. }| {
            support(deck)["value"] = json!([null, null, 0.1]);
            support(deck)["constrained"] = json!([false, false, true]);
        },
        exit: 4,
        told: Told::Before,
        code: "acts-on-nothing",
        names: "DISPLACEMENT of Structure.SidesX has a component out of the plane only",
    },
    Mistake {
        what: "a support that gives and fixes nothing",
        case: PRESSED,
        make: |Files { deck, .. }| {
            support(deck)["value"] = json!([null, null, null]);
            support(deck)["constrained"] = json!([false, false, false]);
        },
        exit: 4,
        told: Told::Before,
        code: "acts-on-nothing",
        names: "gives no component a value, and fixes none",
    },
    Mistake {
        what: "an interval between two steps",
        case: PRESSED,
        make: |Files { deck, .. }| load(deck)["interval"] = json!([0.2, 0.3]),
        exit: 0,
        told: Told::Before,
        code: "interval-outside",
        names: "no step of the run ends in the interval [0.2,0.3]",
    },
    Mistake {
        what: "contact that names no part",
        case: PRESSED,
        make: |Files { deck, .. }| {
            contact(deck)["contact_model_part"] = json!({"0": []});
            contact(deck)["assume_master_slave"] = json!({"0": []});
        },
        exit: 0,
        told: Told::Before,
        code: "whole-skin",
        names: "the whole skin of the bodies is taken",
    },
    Mistake {
        what: "each side the slave of the other",
        case: PRESSED,
        make: |Files { deck, .. }| {
            contact(deck)["contact_model_part"] = json!({"0": ["Interface"], "1": ["Interface"]});
            contact(deck)["assume_master_slave"] = json!({"0": ["Slave"], "1": ["Lower"]});
        },
        exit: 0,
        told: Told::Before,
        code: "mutual-pairs",
        names: "two multipliers would hold one gap",
    },
    Mistake {
        what: "bodies that are one at a node",
        case: PRESSED,
        make: |Files { mesh, .. }| {
            // Node 13 becomes 9: in an element, a condition, and the lists of Upper, Slave, Interface and SidesX.
            for (find, with) in [
                ("\n13 0 1 0\n", "\n"),
                ("7 0 13 14", "7 0 9 14"),
                ("4 0 13 14", "4 0 9 14"),
                ("    13 14 15 16 17", "    9 14 15 16 17"),
                ("    13 14 15 16\n", "    9 14 15 16\n"),
                (" 12 13 14", " 12 14"),
                (" 12 13 16", " 12 16"),
            ] {
                swap(mesh, find, with);
            }
        },
        exit: 0,
        told: Told::Before,
        code: "shared-nodes",
        names: "on both sides of pair \"0\": 9;",
    },
    Mistake {
        what: "a coefficient that the material overrides",
        case: SLIDING,
        make: |Files { deck, materials, .. }| {
            contact(deck)["friction_coefficients"] = json!({"0": 0.4});
            for material in materials["properties"].as_array_mut().expect("a list") {
                material["Material"]["Variables"]["FRICTION_COEFFICIENT"] = json!(0.3);
            }
        },
        exit: 0,
        told: Told::Before,
        code: "friction-overridden",
        names: "gives pair \"0\" 0.4, FRICTION_COEFFICIENT of properties",
    },
    Mistake {
        what: "a coefficient where there is no friction",
        case: PRESSED,
        make: |Files { deck, .. }| contact(deck)["friction_coefficients"] = json!({"0": 0.4}),
        exit: 0,
        told: Told::Before,
        code: "key-without-effect",
        names: "choose \"Frictional\"",
    },
    Mistake {
        what: "contact by constraints of a type that is not there",
        case: CONSTRAINED,
        make: |Files { deck, .. }| deck["solver_settings"]["mpc_contact_settings"]["contact_type"] = json!("Nonsense"),
        exit: 2,
        told: Told::Before,
        code: "contact-type",
        names: "there is no contact type \"Nonsense\"",
    },
    Mistake {
        what: "a tolerance of zero",
        case: PRESSED,
        make: |Files { deck, .. }| deck["solver_settings"]["residual_relative_tolerance"] = json!(0.0),
        exit: 0,
        told: Told::Before,
        code: "invalid-tolerance",
        names: "only round-off is left",
    },
    Mistake {
        what: "a tolerance of the linear solver below zero",
        case: PRESSED,
        make: |Files { deck, .. }| {
            deck["solver_settings"]["linear_solver_settings"] = json!({"solver_type": "cg", "tolerance": -1.0});
        },
        exit: 2,
        told: Told::Before,
        code: "invalid-tolerance",
        names: "\"tolerance\" is -1",
    },
    Mistake {
        what: "a tolerance of the linear solver that everything meets",
        case: PRESSED,
        make: |Files { deck, .. }| {
            deck["solver_settings"]["linear_solver_settings"] = json!({"solver_type": "cg", "tolerance": 1.5});
        },
        exit: 2,
        told: Told::Before,
        code: "invalid-tolerance",
        names: "no solve would begin",
    },
    Mistake {
        what: "a key of the materials file",
        case: PRESSED,
        make: |Files { materials, .. }| materials["propertis"] = json!([]),
        exit: 0,
        told: Told::Before,
        code: "unknown-key-ignored",
        names: "did you mean \"properties\"",
    },
    Mistake {
        what: "a key of a material",
        case: PRESSED,
        make: |Files { materials, .. }| materials["properties"][0]["Material"]["Varables"] = json!({}),
        exit: 0,
        told: Told::Before,
        code: "unknown-key-ignored",
        names: "did you mean \"Variables\"",
    },
    Mistake {
        what: "a key of a law",
        case: PRESSED,
        make: |Files { materials, .. }| materials["properties"][0]["Material"]["constitutive_law"]["nme"] = json!("x"),
        exit: 0,
        told: Told::Before,
        code: "unknown-key-ignored",
        names: "nothing reads \"nme\"",
    },
    Mistake {
        what: "a body inside the other by most of it",
        case: PRESSED,
        make: |files| {
            held_from_above(files, "-0.01*t");
            files.mesh = raised(&files.mesh, 1.0, -0.8);
        },
        exit: 2,
        told: Told::Before,
        code: "initial-penetration",
        names: "move the bodies apart",
    },
    Mistake {
        what: "a body a little inside the other",
        case: PRESSED,
        make: |files| {
            held_from_above(files, "0.0*t");
            files.mesh = raised(&files.mesh, 1.0, -0.03);
        },
        exit: 0,
        told: Told::Before,
        code: "initial-penetration",
        names: "by 3.000e-2",
    },
    Mistake {
        what: "bodies that pass each other within a step",
        case: PRESSED,
        make: |files| {
            held_from_above(files, "-5.0*t");
            files.mesh = raised(&files.mesh, 1.0, 2.0);
        },
        exit: 0,
        told: Told::Run,
        code: "",
        names: "go through the master within the step",
    },
    Mistake {
        what: "sides that are far apart for the whole run",
        case: PRESSED,
        make: |files| {
            held_from_above(files, "-0.5*t");
            files.mesh = raised(&files.mesh, 1.0, 25.0);
        },
        exit: 0,
        told: Told::Run,
        code: "never-met",
        names: "2.450e1 apart at the end",
    },
    Mistake {
        what: "the wrong faces",
        case: PRESSED,
        make: |files| {
            held_from_above(files, "-0.9*t");
            files.mesh = raised(&files.mesh, 1.0, 0.1);
            files.deck["solver_settings"]["time_stepping"]["time_step"] = json!(0.25);
            contact(&mut files.deck)["contact_model_part"] = json!({"0": ["Lower", "Top"]});
            contact(&mut files.deck)["assume_master_slave"] = json!({"0": ["Top"]});
        },
        exit: 3,
        told: Told::Run,
        code: "",
        names: "inside a body by more than 0.2 of their mesh size",
    },
    Mistake {
        what: "a penalty that is too soft",
        case: PRESSED,
        make: |Files { deck, .. }| {
            deck["solver_settings"]["contact_settings"]["mortar_type"] = json!("PenaltyContactFrictionless");
            deck["processes"]["contact_process_list"][0]["python_module"] = json!("penalty_contact_process");
            contact(deck)["advance_ALM_parameters"] = json!({"manual_ALM": true, "penalty": 1e7});
        },
        exit: 3,
        told: Told::Run,
        code: "",
        names: "inside the master by more than 0.2 of their mesh size",
    },
    Mistake {
        what: "a load condition without a length",
        case: PRESSED,
        make: |Files { mesh, .. }| swap(mesh, "\n7 0 22 21\n", "\n7 0 22 22\n"),
        exit: 2,
        told: Told::Before,
        code: "",
        names: "it has no size",
    },
    Mistake {
        what: "a contact face without a length",
        case: PRESSED,
        make: |Files { mesh, .. }| swap(mesh, "\n14 0.333333333333 1 0\n", "\n14 0 1 0\n"),
        exit: 2,
        told: Told::Before,
        code: "degenerate-facet",
        names: "has no area: its nodes are 13, 14",
    },
    Mistake {
        what: "an element twice",
        case: PRESSED,
        make: |Files { mesh, .. }| {
            swap(mesh, "\n1 0 1 2 6 5\n", "\n1 0 1 2 6 5\n901 0 2 6 5 1\n");
            list(mesh, "Lower", "Elements", 901);
        },
        exit: 0,
        told: Told::Before,
        code: "listed-twice",
        names: "901 with those of 1",
    },
    Mistake {
        what: "a load condition twice",
        case: PRESSED,
        make: |Files { mesh, .. }| {
            swap(mesh, "\n7 0 22 21\n", "\n7 0 22 21\n902 0 21 22\n");
            list(mesh, "Top", "Conditions", 902);
        },
        exit: 0,
        told: Told::Before,
        code: "listed-twice",
        names: "902 with those of 7",
    },
    Mistake {
        what: "a node twice",
        case: PRESSED,
        make: |Files { mesh, .. }| swap(mesh, "\n14 0.333333333333 1 0\n", "\n14 0.333333333333 1 0\n14 0.3 1 0\n"),
        exit: 2,
        told: Told::Before,
        code: "",
        names: "14",
    },
    Mistake {
        what: "two values of one unknown",
        case: PRESSED,
        make: |Files { deck, .. }| {
            let supports = deck["processes"]["constraints_process_list"].as_array_mut().expect("a list");
            let mut other = supports[0].clone();
            other["Parameters"]["value"] = json!([null, "0.001*t", null]);
            supports.push(other);
        },
        exit: 0,
        told: Told::Before,
        code: "contradicting-values",
        names: "the first is node 1: 0 by",
    },
    Mistake {
        what: "a body that only contact holds",
        case: PRESSED,
        make: |_| {},
        exit: 0,
        told: Told::Before,
        code: "held-by-contact",
        names: "part Upper",
    },
    Mistake {
        what: "a body that nothing holds",
        case: PRESSED,
        make: |Files { deck, .. }| {
            deck["processes"]["constraints_process_list"].as_array_mut().expect("a list").truncate(1);
        },
        exit: 4,
        told: Told::Before,
        code: "held-by-nothing",
        names: "support it in all directions",
    },
    Mistake {
        what: "a body that only friction holds",
        case: SLIDING,
        make: |Files { deck, .. }| {
            deck["processes"]["constraints_process_list"].as_array_mut().expect("a list").truncate(1);
        },
        exit: 0,
        told: Told::Before,
        code: "held-by-friction",
        names: "part Upper",
    },
    Mistake {
        what: "whole bodies as parts of contact",
        case: PRESSED,
        make: |Files { deck, .. }| {
            contact(deck)["contact_model_part"] = json!({"0": ["Lower", "Upper"]});
            contact(deck)["assume_master_slave"] = json!({"0": ["Upper"]});
        },
        exit: 0,
        told: Told::Before,
        code: "whole-body",
        names: "\"Upper\"",
    },
    Mistake {
        what: "bodies of revolution in plane contact",
        case: "contact_2d/hertz_spheres_light_coarse",
        make: |Files { deck, .. }| contact(deck)["alternative_formulations"]["axisymmetric"] = json!(false),
        exit: 0,
        told: Told::Before,
        code: "contact-of-revolution",
        names: "areas are off by 2πr",
    },
    Mistake {
        what: "a key of the steps",
        case: PRESSED,
        make: |Files { deck, .. }| deck["solver_settings"]["time_stepping"]["time_stp"] = json!(0.1),
        exit: 0,
        told: Told::Before,
        code: "unknown-key-ignored",
        names: "time_step",
    },
    Mistake {
        what: "an element in two parts with unlike materials",
        case: PRESSED,
        make: |Files { mesh, .. }| list(mesh, "Upper", "Elements", 1),
        exit: 2,
        told: Told::Before,
        code: "element-in-two-materials",
        names: "element 1 is in the parts \"Structure.Lower\" and \"Structure.Upper\"",
    },
    Mistake {
        what: "a node of a body that is not merged",
        case: "structural/self_weight",
        make: |Files { mesh, .. }| {
            swap(mesh, "1 0 1 2 4 3 5 6 8 7", "1 0 1 2 4 3 21 6 8 7");
            swap(mesh, "\n20 0.5 0.5 2\n", "\n20 0.5 0.5 2\n21 0 1e-8 0.5\n");
            list(mesh, "Body", "Nodes", 21);
        },
        exit: 0,
        told: Told::Before,
        code: "coincident-nodes",
        names: "5 and 21 at (0, 0, 0.5)",
    },
    Mistake {
        what: "bodies that touch and that nothing couples",
        case: PRESSED,
        make: |files| {
            held_from_above(files, "-0.01*t");
            files.deck["processes"]["contact_process_list"] = json!([]);
        },
        exit: 0,
        told: Told::Before,
        code: "coincident-nodes",
        names: "two nodes stand at 4 places and nothing couples them",
    },
    Mistake {
        what: "a quadrilateral that names a node twice",
        case: "structural/bar_thickness",
        make: |Files { mesh, .. }| swap(mesh, "\n1 0 1 2 7 6\n", "\n1 0 1 1 7 6\n"),
        exit: 0,
        told: Told::Before,
        code: "collapsed-element",
        names: "SmallDisplacementElement2D4N 1 with node 1",
    },
    Mistake {
        what: "elements that lock",
        case: PRESSED,
        make: |Files { materials, .. }| {
            materials["properties"][1]["Material"]["Variables"]["POISSON_RATIO"] = json!(0.4999);
        },
        exit: 0,
        told: Told::Before,
        code: "locking",
        names: "of part Upper locks at POISSON_RATIO 0.4999",
    },
    Mistake {
        what: "a pair of bodies of unlike thickness",
        case: PRESSED,
        make: |Files { materials, .. }| {
            materials["properties"][1]["Material"]["Variables"]["THICKNESS"] = json!(0.1);
        },
        exit: 0,
        told: Told::Before,
        code: "unlike-sections",
        names: "THICKNESS 0.1 (properties 2) and 1 (properties 1)",
    },
    Mistake {
        what: "a pair of a body in plane stress and one in plane strain",
        case: PRESSED,
        make: |Files { materials, .. }| {
            materials["properties"][1]["Material"]["constitutive_law"]["name"] = json!("LinearElasticPlaneStress2DLaw");
        },
        exit: 0,
        told: Told::Before,
        code: "unlike-sections",
        names: "a body in plane stress (properties 2) and one in plane strain (properties 1)",
    },
    Mistake {
        what: "Young's modulus in another unit",
        case: PRESSED,
        make: |Files { materials, .. }| {
            materials["properties"][1]["Material"]["Variables"]["YOUNG_MODULUS"] = json!(1e3);
        },
        exit: 0,
        told: Told::Run,
        code: "large-motion",
        names: "times the size of the model",
    },
    Mistake {
        what: "a strain beyond small displacements",
        case: PRESSED,
        make: |Files { materials, .. }| {
            materials["properties"][1]["Material"]["Variables"]["YOUNG_MODULUS"] = json!(1e6);
        },
        exit: 0,
        told: Told::Run,
        code: "large-strain",
        names: "the element holds for small displacements only",
    },
    Mistake {
        what: "a face of a nodal pressure the other way round",
        case: "structural/load_table",
        make: |Files { mesh, .. }| swap(mesh, "\n2 0 15 14\n", "\n2 0 14 15\n"),
        exit: 0,
        told: Told::Before,
        code: "face-pressure-mixed",
        names: "presses on 1 face and pulls at 1",
    },
    Mistake {
        what: "a table that ends before the run",
        case: "structural/load_table",
        make: |Files { deck, .. }| deck["problem_data"]["end_time"] = json!(8.0),
        exit: 0,
        told: Told::Before,
        code: "table-ends-early",
        names: "load.csv ends at time 4, and the run continues until 8",
    },
    Mistake {
        what: "a contact process listed twice",
        case: "contact_2d/nitsche",
        make: |Files { deck, .. }| {
            let list = deck["processes"]["contact_process_list"].as_array_mut().expect("a list");
            let same = list[0].clone();
            list.push(same);
        },
        exit: 0,
        told: Told::Before,
        code: "pair-given-twice",
        names: "nitsche_contact_process puts contact between surfaces that have it by nitsche_contact_process",
    },
    Mistake {
        what: "a coefficient of friction on the master only",
        case: SLIDING,
        make: |Files { deck, materials, .. }| {
            contact(deck).as_object_mut().expect("settings").remove("friction_coefficients");
            materials["properties"][0]["Material"]["Variables"]["FRICTION_COEFFICIENT"] = json!(0.3);
            materials["properties"][1]["Material"]["Variables"]
                .as_object_mut()
                .expect("constants")
                .remove("FRICTION_COEFFICIENT");
        },
        exit: 0,
        told: Told::Before,
        code: "no-friction",
        names: "FRICTION_COEFFICIENT",
    },
    Mistake {
        what: "a history of values that nodes do not have",
        case: PRESSED,
        make: |Files { deck, .. }| {
            let mut found = false;
            for process in deck["processes"]["json_output_process_list"].as_array_mut().expect("a list") {
                process["Parameters"]["output_variables"] = json!(["TEMPERATURE"]);
                found = true;
            }
            assert!(found, "a history");
        },
        exit: 0,
        told: Told::Run,
        code: "no-values",
        names: "json_output_process writes TEMPERATURE as zeros",
    },
    Mistake {
        what: "an output whose interval is longer than the run",
        case: PRESSED,
        make: |Files { deck, .. }| {
            deck["output_processes"]["pictures"] = json!([{"python_module": "vtu_output_process", "Parameters": {
                "model_part_name": "Structure", "output_interval": 1e30}}]);
        },
        exit: 0,
        told: Told::Run,
        code: "no-output",
        names: "no step of the run is one of its interval of output",
    },
    Mistake {
        what: "a history without variables",
        case: PRESSED,
        make: |Files { deck, .. }| {
            deck["processes"]["json_output_process_list"][0]["Parameters"]["output_variables"] = json!([]);
        },
        exit: 0,
        told: Told::Before,
        code: "no-output",
        names: "json_output_process writes no values of any step: it names no variable",
    },
    Mistake {
        what: "a picture of a quantity that elements do not compute",
        case: PRESSED,
        make: |Files { deck, .. }| {
            deck["output_processes"]["pictures"] = json!([{"python_module": "vtu_output_process", "Parameters": {
                "model_part_name": "Structure", "gauss_point_variables_in_elements": ["TEMPERATURE_GRADIENT"]}}]);
        },
        exit: 0,
        told: Told::Run,
        code: "no-values",
        names: "writes TEMPERATURE_GRADIENT as zeros: Gauss points of elements have no such values",
    },
    Mistake {
        what: "a penalty that changes nothing",
        case: PRESSED,
        make: |Files { deck, .. }| contact(deck)["advance_ALM_parameters"] = json!({"adapt_penalty": true}),
        exit: 0,
        told: Told::Before,
        code: "key-without-effect",
        names: "\"adapt_penalty\" changes nothing",
    },
];
