//! What a deck asks for and nothing does: each has a code of its own, and good decks hear none of them.

mod support;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use support::{read_json, root, said, scratch_copy, zelus};

const DECK: &str = "ProjectParameters.json";
const CODES: [&str; 20] = [
    "acts-on-nothing",
    "contradicting-values",
    "duplicate-key",
    "friction-overridden",
    "held-by-nothing",
    "initial-penetration",
    "interval-reversed",
    "invalid-tolerance",
    "listed-twice",
    "load-given-twice",
    "mutual-pairs",
    "negative-friction",
    "no-friction",
    "one-body",
    "repeated-properties",
    "settings-without-process",
    "slave-in-two-pairs",
    "slaves-without-pair",
    "unknown-key-ignored",
    "whole-body",
];

/// A deck with one mistake.
struct Mistake {
    what: &'static str,
    case: &'static str,
    make: fn(&mut Value, &mut Value),
    exit: i32,
    code: &'static str,
    /// Words of the message: what it is about.
    names: &'static str,
}

fn load(deck: &mut Value) -> &mut Value {
    &mut deck["processes"]["loads_process_list"][0]["Parameters"]
}

fn contact(deck: &mut Value) -> &mut Value {
    &mut deck["processes"]["contact_process_list"][0]["Parameters"]
}

/// The supports of the sides.
fn support(deck: &mut Value) -> &mut Value {
    &mut deck["processes"]["constraints_process_list"][1]["Parameters"]
}

const PRESSED: &str = "contact_2d/matching";
const SLIDING: &str = "contact_2d/friction_slide";

const CONSTRAINED: &str = "mpc/pressed_and_opened";

const MISTAKES: [Mistake; 37] = [
    Mistake {
        what: "one load by two processes",
        case: PRESSED,
        make: |deck, _| {
            let loads = deck["processes"]["loads_process_list"].as_array_mut().expect("a list");
            let mut other = loads[0].clone();
            other["Parameters"]["direction"] = json!([1.0, 0.0, 0.0]);
            other["Parameters"]["interval"] = json!([0.5, "End"]);
            loads.push(other);
        },
        exit: 0,
        code: "load-given-twice",
        names: "LINE_LOAD of 3 conditions is given by",
    },
    Mistake {
        what: "a pair of faces of one body",
        case: PRESSED,
        make: |deck, _| {
            contact(deck)["contact_model_part"] = json!({"0": ["Slave", "Top"]});
            contact(deck)["assume_master_slave"] = json!({"0": ["Slave"]});
        },
        exit: 2,
        code: "one-body",
        names: "both sides are faces of one body, that of node 13, and no slave node has the master before it",
    },
    Mistake {
        what: "a surface load on lines",
        case: PRESSED,
        make: |deck, _| load(deck)["variable_name"] = json!("SURFACE_LOAD"),
        exit: 0,
        code: "acts-on-nothing",
        names: "no condition of Structure.Top takes SURFACE_LOAD",
    },
    Mistake {
        what: "a point load on lines",
        case: PRESSED,
        make: |deck, _| load(deck)["variable_name"] = json!("POINT_LOAD"),
        exit: 0,
        code: "acts-on-nothing",
        names: "POINT_LOAD",
    },
    Mistake {
        what: "a load out of the plane",
        case: PRESSED,
        make: |deck, _| load(deck)["direction"] = json!([0.0, 0.0, 1.0]),
        exit: 0,
        code: "acts-on-nothing",
        names: "out of the plane",
    },
    Mistake {
        what: "a load on a part of nodes",
        case: "contact_2d/parts_of_nodes",
        make: |deck, _| load(deck)["model_part_name"] = json!("Structure.Bottom"),
        exit: 0,
        code: "acts-on-nothing",
        names: "has no conditions",
    },
    Mistake {
        what: "an interval that ends before it begins",
        case: PRESSED,
        make: |deck, _| load(deck)["interval"] = json!([1.0, 0.0]),
        exit: 0,
        code: "interval-reversed",
        names: "[1.0,0.0]",
    },
    Mistake {
        what: "an interval after the run",
        case: PRESSED,
        make: |deck, _| load(deck)["interval"] = json!([5.0, 6.0]),
        exit: 0,
        code: "interval-outside",
        names: "0 to 1",
    },
    Mistake {
        what: "an interval from zero to the end of the run",
        case: PRESSED,
        make: |deck, _| {
            deck["solver_settings"]["time_stepping"] = json!({"time_step": 0.5});
            load(deck)["interval"] = json!([0.0, 1.0]);
        },
        exit: 0,
        code: "interval-end",
        names: "leaves out the last step, which ends at 1",
    },
    Mistake {
        what: "contact settings without contact",
        case: PRESSED,
        make: |deck, _| deck["processes"]["contact_process_list"] = json!([]),
        exit: 4,
        code: "settings-without-process",
        names: "contact_settings",
    },
    Mistake {
        what: "friction below zero in the materials",
        case: SLIDING,
        make: |deck, materials| {
            contact(deck).as_object_mut().expect("settings").remove("friction_coefficients");
            for material in materials["properties"].as_array_mut().expect("a list") {
                material["Material"]["Variables"]["FRICTION_COEFFICIENT"] = json!(-0.3);
            }
        },
        exit: 2,
        code: "negative-friction",
        names: "-0.3",
    },
    Mistake {
        what: "friction without a coefficient",
        case: SLIDING,
        make: |deck, _| {
            contact(deck).as_object_mut().expect("settings").remove("friction_coefficients");
        },
        exit: 0,
        code: "no-friction",
        names: "FRICTION_COEFFICIENT",
    },
    Mistake {
        what: "a coefficient for a pair that is not there",
        case: SLIDING,
        make: |deck, _| contact(deck)["friction_coefficients"] = json!({"9": 0.3}),
        exit: 0,
        code: "no-friction",
        names: "FRICTION_COEFFICIENT",
    },
    Mistake {
        what: "slaves of a pair that is not there",
        case: PRESSED,
        make: |deck, _| contact(deck)["assume_master_slave"] = json!({"7": ["Slave"]}),
        exit: 0,
        code: "slaves-without-pair",
        names: "\"7\"",
    },
    Mistake {
        what: "one slave side in two pairs",
        case: PRESSED,
        make: |deck, _| {
            contact(deck)["contact_model_part"] = json!({"0": ["Interface"], "1": ["Interface"]});
            contact(deck)["assume_master_slave"] = json!({"0": ["Slave"], "1": ["Slave"]});
        },
        exit: 0,
        code: "slave-in-two-pairs",
        names: "pair \"0\" and of pair \"1\"",
    },
    Mistake {
        what: "two materials with one id",
        case: PRESSED,
        make: |_, materials| {
            for material in materials["properties"].as_array_mut().expect("a list") {
                material["properties_id"] = json!(1);
            }
        },
        exit: 2,
        code: "repeated-properties",
        names: "properties 1",
    },
    Mistake {
        what: "a tolerance below zero",
        case: PRESSED,
        make: |deck, _| deck["solver_settings"]["residual_relative_tolerance"] = json!(-1e-4),
        exit: 2,
        code: "invalid-tolerance",
        names: "nothing is below it",
    },
    Mistake {
        what: "a tolerance that everything meets",
        case: PRESSED,
        make: |deck, _| deck["solver_settings"]["contact_settings"]["contact_residual_relative_tolerance"] = json!(2),
        exit: 2,
        code: "invalid-tolerance",
        names: "contact_residual_relative_tolerance",
    },
    Mistake {
        what: "a key beside the parameters of a process",
        case: PRESSED,
        make: |deck, _| deck["processes"]["loads_process_list"][0]["Paramters"] = json!({}),
        exit: 0,
        code: "unknown-key-ignored",
        names: "Parameters",
    },
    Mistake {
        what: "a key of the problem data",
        case: PRESSED,
        make: |deck, _| deck["problem_data"]["end_tme"] = json!(3),
        exit: 0,
        code: "unknown-key-ignored",
        names: "end_time",
    },
    Mistake {
        what: "a key of the mesh",
        case: PRESSED,
        make: |deck, _| deck["solver_settings"]["model_import_settings"]["filename"] = json!("x"),
        exit: 0,
        code: "unknown-key-ignored",
        names: "filename",
    },
    Mistake {
        what: "a key of the linear solver",
        case: PRESSED,
        make: |deck, _| {
            let settings = json!({"solver_type": "skyline_lu_factorization", "tollerance": 1e-9});
            deck["solver_settings"]["linear_solver_settings"] = settings;
        },
        exit: 0,
        code: "unknown-key-ignored",
        names: "tolerance",
    },
    Mistake {
        what: "a load out of the plane, as a function",
        case: PRESSED,
        make: |deck, _| {
            load(deck)["direction"] = json!([0.0, 0.0, 1.0]);
            load(deck)["modulus"] = json!("1e6*t");
        },
        exit: 0,
        code: "acts-on-nothing",
        names: "out of the plane",
    },
    Mistake {
        what: "a motion out of the plane",
        case: PRESSED,
        make: |deck, _| {
            support(deck)["value"] = json!([null, null, 0.1]);
            support(deck)["constrained"] = json!([false, false, true]);
        },
        exit: 4,
        code: "acts-on-nothing",
        names: "DISPLACEMENT of Structure.SidesX has a component out of the plane only",
    },
    Mistake {
        what: "a support that gives and fixes nothing",
        case: PRESSED,
        make: |deck, _| {
            support(deck)["value"] = json!([null, null, null]);
            support(deck)["constrained"] = json!([false, false, false]);
        },
        exit: 4,
        code: "acts-on-nothing",
        names: "gives no component a value, and fixes none",
    },
    Mistake {
        what: "an interval between two steps",
        case: PRESSED,
        make: |deck, _| load(deck)["interval"] = json!([0.2, 0.3]),
        exit: 0,
        code: "interval-outside",
        names: "no step of the run ends in the interval [0.2,0.3]",
    },
    Mistake {
        what: "contact that names no part",
        case: PRESSED,
        make: |deck, _| {
            contact(deck)["contact_model_part"] = json!({"0": []});
            contact(deck)["assume_master_slave"] = json!({"0": []});
        },
        exit: 0,
        code: "whole-skin",
        names: "the whole skin of the bodies is taken",
    },
    Mistake {
        what: "each side the slave of the other",
        case: PRESSED,
        make: |deck, _| {
            contact(deck)["contact_model_part"] = json!({"0": ["Interface"], "1": ["Interface"]});
            contact(deck)["assume_master_slave"] = json!({"0": ["Slave"], "1": ["Lower"]});
        },
        exit: 0,
        code: "mutual-pairs",
        names: "two multipliers would hold one gap",
    },
    Mistake {
        what: "a coefficient that the material overrides",
        case: SLIDING,
        make: |deck, materials| {
            contact(deck)["friction_coefficients"] = json!({"0": 0.4});
            for material in materials["properties"].as_array_mut().expect("a list") {
                material["Material"]["Variables"]["FRICTION_COEFFICIENT"] = json!(0.3);
            }
        },
        exit: 0,
        code: "friction-overridden",
        names: "gives pair \"0\" 0.4, FRICTION_COEFFICIENT of properties",
    },
    Mistake {
        what: "a coefficient where there is no friction",
        case: PRESSED,
        make: |deck, _| contact(deck)["friction_coefficients"] = json!({"0": 0.4}),
        exit: 0,
        code: "key-without-effect",
        names: "choose \"Frictional\"",
    },
    Mistake {
        what: "contact by constraints of a type that is not there",
        case: CONSTRAINED,
        make: |deck, _| deck["solver_settings"]["mpc_contact_settings"]["contact_type"] = json!("Nonsense"),
        exit: 2,
        code: "contact-type",
        names: "there is no contact type \"Nonsense\"",
    },
    Mistake {
        what: "a tolerance of zero",
        case: PRESSED,
        make: |deck, _| deck["solver_settings"]["residual_relative_tolerance"] = json!(0.0),
        exit: 0,
        code: "invalid-tolerance",
        names: "only round-off is left",
    },
    Mistake {
        what: "a tolerance of the linear solver below zero",
        case: PRESSED,
        make: |deck, _| {
            deck["solver_settings"]["linear_solver_settings"] = json!({"solver_type": "cg", "tolerance": -1.0});
        },
        exit: 2,
        code: "invalid-tolerance",
        names: "\"tolerance\" is -1",
    },
    Mistake {
        what: "a tolerance of the linear solver that everything meets",
        case: PRESSED,
        make: |deck, _| {
            deck["solver_settings"]["linear_solver_settings"] = json!({"solver_type": "cg", "tolerance": 1.5});
        },
        exit: 2,
        code: "invalid-tolerance",
        names: "no solve would begin",
    },
    Mistake {
        what: "a key of the materials file",
        case: PRESSED,
        make: |_, materials| materials["propertis"] = json!([]),
        exit: 0,
        code: "unknown-key-ignored",
        names: "did you mean \"properties\"",
    },
    Mistake {
        what: "a key of a material",
        case: PRESSED,
        make: |_, materials| materials["properties"][0]["Material"]["Varables"] = json!({}),
        exit: 0,
        code: "unknown-key-ignored",
        names: "did you mean \"Variables\"",
    },
    Mistake {
        what: "a key of a law",
        case: PRESSED,
        make: |_, materials| materials["properties"][0]["Material"]["constitutive_law"]["nme"] = json!("x"),
        exit: 0,
        code: "unknown-key-ignored",
        names: "nothing reads \"nme\"",
    },
];

fn go(command: &str, folder: &Path) -> (Option<i32>, String) {
    let output = zelus(folder, &[command, DECK]);
    (output.status.code(), said(&output))
}

/// The warnings and errors of a run with what to do about them, where folders are no part of them.
fn messages(said: &str) -> String {
    let mut out = String::new();
    let mut remedy = false;
    for line in said.lines() {
        let begins = ["note[", "warning[", "error["].iter().any(|word| line.starts_with(word));
        if begins || (remedy && line.starts_with("    ") && !line.trim().is_empty()) {
            writeln!(out, "{line}").expect("text");
        }
        remedy = begins;
    }
    out
}

/// Every message stands on one page, with its code, fact and remedy: `snapshots/unheeded__mistakes.snap`.
#[test]
fn what_nothing_does_is_named() {
    let mut page = String::new();
    for Mistake { what, case, make, exit, code, names } in MISTAKES {
        let scratch = scratch_copy(&root().join("tests/cases").join(case));
        let paths = [DECK, "StructuralMaterials.json"].map(|name| scratch.path().join(name));
        let [mut deck, mut materials] = paths.each_ref().map(|path| read_json(path).expect("JSON"));
        make(&mut deck, &mut materials);
        for (path, json) in paths.iter().zip([deck, materials]) {
            std::fs::write(path, serde_json::to_string_pretty(&json).expect("JSON")).expect("a file");
        }
        // What fails when it is solved has no errors before.
        let found = if exit == 2 { 2 } else { 0 };
        for (command, exit) in [("check", found), ("run", exit)] {
            let (status, said) = go(command, scratch.path());
            assert_eq!(status, Some(exit), "{command}: {what}: {said}");
            assert!(said.contains(&format!("[{code}]")) && said.contains(names), "{command}: {what}: {said}");
            if command == "check" {
                writeln!(page, "== {what} ==\n{}", messages(&said)).expect("text");
            }
        }
    }
    insta::assert_snapshot!("mistakes", page);
}

/// Nine mistakes that have nothing to do with each other take one round, also where the mesh cannot be read.
#[test]
fn nine_mistakes_are_named_at_once() {
    for reads in [true, false] {
        let scratch = scratch_copy(&root().join("tests/cases").join(PRESSED));
        let paths = [DECK, "StructuralMaterials.json"].map(|name| scratch.path().join(name));
        let [mut deck, mut materials] = paths.each_ref().map(|path| read_json(path).expect("JSON"));
        let solver = &mut deck["solver_settings"];
        solver["max_iteration"] = json!(0);
        solver["convergence_criterion"] = json!("contact_residul_criterion");
        solver["residual_relative_tolerance"] = json!(-1e-9);
        solver["time_stepping"]["time_step"] = json!(-1.0);
        solver["contact_settings"]["mortar_type"] = json!("ALMContactFrictionles");
        load(&mut deck)["variable_name"] = json!("LINE_LOD");
        support(&mut deck)["model_part_name"] = json!("Structure.Sides");
        contact(&mut deck)["contact_type"] = json!("Nonsense");
        contact(&mut deck)["contact_model_part"] = json!({"0": ["Interfac"]});
        materials["properties"][0]["Material"]["constitutive_law"]["name"] = json!("LinearElasticPlainStrain2DLaw");
        for (path, json) in paths.iter().zip([deck, materials]) {
            std::fs::write(path, serde_json::to_string_pretty(&json).expect("JSON")).expect("a file");
        }
        let mesh = scratch.path().join("mesh.mdpa");
        if !reads {
            let text = std::fs::read_to_string(&mesh).expect("the mesh");
            std::fs::write(&mesh, text.replace("Element2D4N", "Element2D4")).expect("a file");
        }
        for command in ["check", "run"] {
            let (status, said) = go(command, scratch.path());
            assert_eq!(status, Some(2), "{said}");
            let names = [
                "max_iteration",
                "contact_residul_criterion",
                "residual_relative_tolerance",
                "time_step",
                "ALMContactFrictionles\"",
                "LINE_LOD",
                "Structure.Sides\"",
                "Nonsense",
                "\"Interfac\"",
                if reads { "LinearElasticPlainStrain2DLaw" } else { "SmallDisplacementElement2D4`" },
            ];
            let unsaid: Vec<&str> = names.into_iter().filter(|name| !said.contains(name)).collect();
            assert!(unsaid.is_empty(), "{command} does not say {unsaid:?}:\n{said}");
            // What follows from a mistake is none of its own.
            assert_eq!(said.matches("error[").count(), if reads { 10 } else { 12 }, "{said}");
        }
    }
}

#[test]
fn programs_read_problems_as_json() {
    let scratch = scratch_copy(&root().join("tests/cases").join(PRESSED));
    let path = scratch.path().join(DECK);
    let check = |edit: fn(&mut Value)| {
        let mut deck = read_json(&path).expect("the deck");
        edit(&mut deck);
        std::fs::write(&path, serde_json::to_string_pretty(&deck).expect("JSON")).expect("a file");
        let output = zelus(scratch.path(), &["check", DECK, "--format", "json"]);
        let told: Value = serde_json::from_slice(&output.stdout).expect("JSON alone");
        assert_eq!(told["exit_code"], json!(output.status.code()), "{told}");
        told
    };
    let find = |told: &Value, code: &str| {
        let problems = told["problems"].as_array().expect("a list");
        problems.iter().find(|problem| problem["code"] == code).cloned().unwrap_or_else(|| panic!("no {code}: {told}"))
    };
    let warned = find(&check(|deck| load(deck)["variable_name"] = json!("SURFACE_LOAD")), "acts-on-nothing");
    assert!(warned["severity"] == "warning" && warned["remedy"].is_string(), "{warned}");
    let told = check(|deck| deck["solver_settings"]["residual_relative_tolerance"] = json!(-1.0));
    let error = find(&told, "invalid-tolerance");
    assert_eq!(told["exit_code"], 2);
    assert!(error["severity"] == "error" && error["file"] == DECK && error["line"].as_u64() > Some(1), "{error}");
}

#[test]
fn keys_given_twice_are_named() {
    let scratch = scratch_copy(&root().join("tests/cases").join(PRESSED));
    let path = scratch.path().join(DECK);
    let text = std::fs::read_to_string(&path).expect("the deck");
    std::fs::write(&path, text.replacen("\"max_iteration\":", "\"max_iteration\": 7, \"max_iteration\":", 1))
        .expect("a file");
    let (status, said) = go("run", scratch.path());
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("warning[duplicate-key]") && said.contains("max_iteration"), "{said}");
}

/// What a linear solver reads is no mistake, whichever of its settings it is.
#[test]
fn settings_of_linear_solvers_are_read() {
    let scratch = scratch_copy(&root().join("tests/cases").join(PRESSED));
    let path = scratch.path().join(DECK);
    let mut deck = read_json(&path).expect("JSON");
    let settings = json!({"solver_type": "multigrid", "tolerance": 1e-8, "direct_below": 100, "memory_limit": 50.0});
    deck["solver_settings"]["linear_solver_settings"] = settings;
    std::fs::write(&path, deck.to_string()).expect("a file");
    let (status, said) = go("run", scratch.path());
    assert_eq!(status, Some(0), "{said}");
    assert!(!said.contains("nothing reads"), "{said}");
}

fn decks_below(folder: &Path, out: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    for path in paths {
        match path.is_dir() {
            true => decks_below(&path, out),
            false if path.file_name().is_some_and(|name| name == DECK) => out.push(path),
            false => {}
        }
    }
}

/// `zelus check` says none of these of the decks of the repository, and of those of `ZELUS_SHARED` where there are any.
#[test]
fn good_decks_hear_none_of_it() {
    let mut decks = Vec::new();
    decks_below(&root().join("tests/cases"), &mut decks);
    decks_below(&root().join("examples"), &mut decks);
    let shared = std::env::var_os("ZELUS_SHARED").map_or_else(|| root().join("../shared"), PathBuf::from);
    let own = decks.len();
    decks_below(&shared.join("decks"), &mut decks);
    if decks.len() == own {
        println!("skipped: decks of {}, which is not there", shared.display());
    }
    assert!(own > 100, "{own} decks");
    let mut wrong = Vec::new();
    for deck in decks {
        let output = zelus(deck.parent().expect("a folder"), &["check", DECK]);
        let said = said(&output);
        // A shrink fit begins with bodies inside each other; nodes of the boundary that are pulled are prescribed twice;
        // a case has friction twice, to see which counts.
        let own = deck.parent().and_then(Path::file_name).map(|name| name.to_string_lossy().into_owned());
        let meant = |code: &str| {
            [
                ("initial-penetration", "shrink_fit"),
                ("contradicting-values", "mixture_of_layers"),
                ("friction-overridden", "friction_from_properties"),
            ]
            .contains(&(code, own.as_deref().unwrap_or_default()))
        };
        let heard = CODES.iter().filter(|code| said.contains(&format!("[{code}]")) && !meant(code));
        wrong.extend(heard.map(|code| format!("{}: {code}", deck.display())));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
