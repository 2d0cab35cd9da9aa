//! What a deck asks for and nothing does: each has a code of its own, and good decks hear none of them.

mod support;

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use support::{read_json, root, said, scratch_copy, zelus};

const DECK: &str = "ProjectParameters.json";
const CODES: [&str; 16] = [
    "acts-on-nothing",
    "contradicting-values",
    "duplicate-key",
    "held-by-nothing",
    "initial-penetration",
    "interval-reversed",
    "invalid-tolerance",
    "listed-twice",
    "negative-friction",
    "no-friction",
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

const PRESSED: &str = "contact_2d/matching";
const SLIDING: &str = "contact_2d/friction_slide";

const MISTAKES: [Mistake; 19] = [
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
        names: "0 to 0.5",
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
];

fn go(command: &str, folder: &Path) -> (Option<i32>, String) {
    let output = zelus(folder, &[command, DECK]);
    (output.status.code(), said(&output))
}

#[test]
fn what_nothing_does_is_named() {
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
        }
    }
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
        // A shrink fit begins with bodies inside each other; nodes of the boundary that are pulled are prescribed twice.
        let own = deck.parent().and_then(Path::file_name).map(|name| name.to_string_lossy().into_owned());
        let meant = |code: &str| {
            [("initial-penetration", "shrink_fit"), ("contradicting-values", "mixture_of_layers")]
                .contains(&(code, own.as_deref().unwrap_or_default()))
        };
        let heard = CODES.iter().filter(|code| said.contains(&format!("[{code}]")) && !meant(code));
        wrong.extend(heard.map(|code| format!("{}: {code}", deck.display())));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
