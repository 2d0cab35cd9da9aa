//! Mistakes that a run could pass over: settings without effect, impossible states of contact, unrestrained bodies. Each is reported
//! with its place, fact and remedy, and good decks get no message.

#[path = "../support/blocks_of_case.rs"]
mod blocks_of_case;
#[path = "../support/mod.rs"]
mod support;
mod histories;
mod loads_and_supports;
mod meaning;
mod meshes_and_tables;
mod ranges;
mod table;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use support::{read_json, root, said, scratch_copy, zelus};
use table::{Files, MISTAKES, Mistake, PRESSED, Told, contact, load, support};

const DECK: &str = "ProjectParameters.json";
const MATERIALS: &str = "StructuralMaterials.json";
const MESH: &str = "mesh.mdpa";
const CODES: [&str; 30] = [
    "acts-on-nothing",
    "coincident-nodes",
    "collapsed-element",
    "contact-of-revolution",
    "contradicting-values",
    "duplicate-key",
    "element-in-two-materials",
    "face-pressure-mixed",
    "friction-overridden",
    "held-by-nothing",
    "initial-penetration",
    "interval-reversed",
    "invalid-tolerance",
    "listed-twice",
    "load-given-twice",
    "load-on-support",
    "locking",
    "mutual-pairs",
    "negative-friction",
    "no-friction",
    "one-body",
    "pair-given-twice",
    "repeated-properties",
    "settings-without-process",
    "slave-in-two-pairs",
    "slaves-without-pair",
    "table-ends-early",
    "unknown-key-ignored",
    "unlike-sections",
    "whole-body",
];

fn go(command: &str, folder: &Path) -> (Option<i32>, String) {
    let output = zelus(folder, &[command, DECK]);
    (output.status.code(), said(&output))
}

/// The warnings and errors of a run with their remedies, where folders are no part of them.
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

/// Every message stands on one page, with its code, fact and remedy: `mistakes/mistakes__messages.snap`.
#[test]
fn every_mistake_is_told() {
    let (mut page, mut failed) = (String::new(), Vec::new());
    for Mistake { what, case, make, exit, told, code, names } in MISTAKES {
        let scratch = scratch_copy(&root().join("tests/cases").join(case));
        let at = |name: &str| scratch.path().join(name);
        let [deck, materials] = [DECK, MATERIALS].map(|name| read_json(&at(name)).expect("JSON"));
        let mut files = Files { deck, materials, mesh: std::fs::read_to_string(at(MESH)).expect("the mesh") };
        make(&mut files);
        let pretty = |json: &Value| serde_json::to_string_pretty(json).expect("JSON");
        for (name, text) in [(DECK, pretty(&files.deck)), (MATERIALS, pretty(&files.materials)), (MESH, files.mesh)] {
            std::fs::write(at(name), text).expect("a file");
        }
        let code = if code.is_empty() { String::new() } else { format!("[{code}]") };
        // A deck that fails when it is solved has no errors before.
        let found = if *exit == 2 { 2 } else { 0 };
        for (command, exit) in [("check", found), ("run", *exit)] {
            let (status, said) = go(command, scratch.path());
            let is_told = said.contains(&code) && said.contains(names);
            if status != Some(exit) || !(is_told || command == "check" && *told == Told::Run) {
                failed.push(format!("{command}: {what}: exit code {status:?}, not {exit}; [{code}] {names:?}\n{said}"));
            }
            let shown = if *told == Told::Before { "check" } else { "run" };
            if command == shown {
                // A message during a run is a line of its log.
                let line =
                    said.lines().find(|line| line.contains(names) && code.is_empty() && !line.contains("error["));
                let line = line.map_or_else(String::new, |line| format!("{line}\n"));
                writeln!(page, "== {what} ==\n{line}{}", messages(&said)).expect("text");
            }
        }
    }
    assert!(failed.is_empty(), "{} mistakes\n\n{}", failed.len(), failed.join("\n\n"));
    insta::with_settings!({snapshot_path => "."}, { insta::assert_snapshot!("messages", page) });
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
            // The consequences of a mistake are no mistakes of their own.
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

/// A setting that a linear solver reads is no mistake, whichever of its settings it is.
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
        // a case has friction twice, to see which counts; Kratos' sphere on a plate is of revolution in plane contact; an acceleration
        // is mapped from mesh to mesh without a density.
        let own = deck.parent().and_then(Path::file_name).map(|name| name.to_string_lossy().into_owned());
        let meant = |code: &str| {
            [
                ("initial-penetration", "shrink_fit"),
                ("acts-on-nothing", "mapped_field"),
                ("contradicting-values", "mixture_of_layers"),
                ("friction-overridden", "friction_from_properties"),
                ("contact-of-revolution", "hertz_sphere_plate_test"),
                ("contact-of-revolution", "hertz_sphere_plate_test__components"),
            ]
            .contains(&(code, own.as_deref().unwrap_or_default()))
        };
        let heard = CODES.iter().filter(|code| said.contains(&format!("[{code}]")) && !meant(code));
        wrong.extend(heard.map(|code| format!("{}: {code}", deck.display())));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
