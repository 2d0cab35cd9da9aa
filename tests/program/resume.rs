//! Runs that are stopped, by a signal, by force or between stages, go on to the files of the run that was not.

use crate::support;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::support::{contents, read_json, root, said, scratch_copy, zelus};
use serde_json::{Value, json};
use tempfile::TempDir;

const DECK: &str = "ProjectParameters.json";
/// Runs that are killed in a test.
const KILLS: usize = 100;

/// A deck in a scratch folder, in so many steps, with changes.
fn deck(folder: &str, steps: usize, change: impl Fn(&mut Value)) -> TempDir {
    let scratch = scratch_copy(&root().join("tests").join(folder));
    let path = scratch.path().join(DECK);
    let mut deck = read_json(&path).expect("the deck");
    let end = deck["problem_data"]["end_time"].as_f64().expect("a time");
    deck["solver_settings"]["time_stepping"] = json!({"time_step": end / steps as f64});
    change(&mut deck);
    std::fs::write(path, deck.to_string()).expect("the deck");
    scratch
}

/// Files of results by name: not the saved runs, which hold times of the clock, nor incomplete files.
fn results(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let is_result = |name: &Path| {
        let text = name.to_string_lossy();
        !["__restart_files", "checkpoints", ".rest", ".resume", ".part", DECK].iter().any(|word| text.contains(word))
    };
    contents(folder).into_iter().filter(|(name, _)| is_result(name)).collect()
}

fn assert_same(what: &str, one: &Path, other: &Path) {
    let [one, other] = [results(one), results(other)];
    assert_eq!(one.keys().collect::<Vec<_>>(), other.keys().collect::<Vec<_>>(), "{what}");
    one.iter().for_each(|(name, bytes)| assert!(other[name] == *bytes, "{what}: {} differs", name.display()));
}

fn start(folder: &Path, arguments: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_zelus"));
    command.args(arguments).current_dir(folder).env("NO_COLOR", "1").stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().expect("the program")
}

/// The slide with friction, saved after every step, with files that grow, that are rewritten, and one a step.
fn slide() -> TempDir {
    let process = |name: &str, parameters: Value| json!({"python_module": name, "Parameters": parameters});
    deck("cases/contact_2d/friction_slide", 12, |deck| {
        deck["output_processes"] = json!({"files": [
            process("save_restart_process", json!({"model_part_name": "Structure", "restart_control_type": "step",
                "restart_save_frequency": 1, "max_files_to_keep": 2})),
            process("vtu_output_process", json!({"model_part_name": "Structure", "output_path": "vtu",
                "nodal_solution_step_data_variables": ["DISPLACEMENT"]})),
            process("multiple_points_output_process", json!({"model_part_name": "Structure.Upper",
                "entity_type": "node", "positions": [[0.0, 0.0, 0.0]], "search_tolerance": 100.0,
                "output_variables": ["DISPLACEMENT"], "output_file_settings": {"file_name": "points"}})),
        ]});
    })
}

#[test]
fn a_run_killed_at_any_moments_ends_as_the_one_that_was_not() {
    let whole = slide();
    let begun = Instant::now();
    let output = zelus(whole.path(), &["run", DECK]);
    assert!(output.status.success(), "{}", said(&output));
    let longest = begun.elapsed().as_secs_f64();
    let saved = contents(whole.path()).into_keys().filter(|name| name.starts_with("Structure__restart_files")).count();
    assert_eq!(saved, 2, "two files are kept");
    let mut random = support::random(7);
    let (mut kills, mut ended) = (0, 0);
    while kills < KILLS || ended == 0 {
        let killed = slide();
        loop {
            let threads = ["1", "2"][kills % 2];
            let mut child = start(killed.path(), &["run", DECK, "--resume", "--threads", threads]);
            std::thread::sleep(Duration::from_secs_f64(random() * longest));
            if child.try_wait().expect("a child").is_none() {
                child.kill().expect("a kill");
                kills += 1;
            }
            let output = child.wait_with_output().expect("an end");
            if output.status.success() {
                break;
            }
            assert!(output.status.code().is_none(), "{}", said(&output));
        }
        ended += 1;
        assert_same(&format!("after {kills} kills"), whole.path(), killed.path());
    }
    println!("{kills} kills, {ended} runs that came to their end");
}

#[test]
fn a_signal_stops_after_the_step_and_says_how_to_go_on() {
    let motion = || deck("decks/bouncing_block", 350, |_| {});
    let whole = motion();
    assert!(zelus(whole.path(), &["run", DECK]).status.success());
    for (signal, name) in [("-INT", "SIGINT"), ("-TERM", "SIGTERM")] {
        let mut stopped = false;
        // A signal may come before the run listens to it, or after its end.
        for attempt in 0..20 {
            let folder = motion();
            let child = start(folder.path(), &["run", DECK, "--report", "report.json"]);
            std::thread::sleep(Duration::from_millis(60 + 20 * attempt));
            let id = child.id().to_string();
            Command::new("kill").args([signal, &id]).status().expect("kill");
            let output = child.wait_with_output().expect("an end");
            if output.status.code() != Some(5) {
                continue;
            }
            let said = said(&output);
            let last = said.lines().last().unwrap_or_default();
            assert!(last.contains("stopped at time") && last.contains("run ProjectParameters.json --resume"), "{said}");
            assert!(said.contains("stopping after this step; again to stop now"), "{said}");
            let report = read_json(&folder.path().join("report.json")).expect("a report");
            assert_eq!(report["converged"], json!(false), "{name}");
            std::fs::remove_file(folder.path().join("report.json")).expect("the report");
            let output = zelus(folder.path(), &["run", DECK, "--resume"]);
            assert!(output.status.success(), "{}", support::said(&output));
            assert!(support::said(&output).contains("restart from ProjectParameters.rest"));
            assert_same(name, whole.path(), folder.path());
            stopped = true;
            break;
        }
        assert!(stopped, "{name} never came in time");
    }
}

#[test]
fn stages_are_saved_and_go_on_with_the_keys_of_kratos() {
    let scratch = scratch_copy(&root().join("tests/cases/structural/stages_of_plastic_flow"));
    let path = scratch.path().join(DECK);
    let mut deck = read_json(&path).expect("the deck");
    deck["orchestrator"]["settings"]["stage_checkpoints"] = json!(true);
    std::fs::write(&path, deck.to_string()).expect("the deck");
    let output = zelus(scratch.path(), &["run", DECK]);
    assert!(output.status.success(), "{}", said(&output));
    let whole = results(scratch.path());
    let names: Vec<String> = deck["stages"].as_object().expect("stages").keys().cloned().collect();
    for name in &names {
        deck["orchestrator"]["settings"]["load_from_checkpoint"] = json!(format!("checkpoints/{name}"));
        std::fs::write(&path, deck.to_string()).expect("the deck");
        let output = zelus(scratch.path(), &["run", DECK]);
        assert!(output.status.success(), "{}", said(&output));
        assert!(results(scratch.path()) == whole, "after {name}");
    }
}

#[test]
fn a_deck_begins_with_a_restart_file_in_place_of_a_mesh() {
    let saving = |deck: &mut Value| {
        deck["output_processes"] = json!({"saved": [{"python_module": "save_restart_process",
            "Parameters": {"model_part_name": "Structure", "restart_save_frequency": 0.35}}]});
    };
    let scratch = deck("cases/contact_2d/friction_slide", 10, saving);
    let output = zelus(scratch.path(), &["run", DECK]);
    assert!(output.status.success(), "{}", said(&output));
    let whole = results(scratch.path());
    let path = scratch.path().join(DECK);
    let mut deck = read_json(&path).expect("the deck");
    deck["solver_settings"]["model_import_settings"] =
        json!({"input_type": "rest", "input_filename": "Structure", "restart_load_file_label": "0.4"});
    std::fs::write(&path, deck.to_string()).expect("the deck");
    let output = zelus(scratch.path(), &["run", DECK]);
    assert!(output.status.success(), "{}", said(&output));
    assert!(said(&output).contains("step 5,") && !said(&output).contains("step 4,"), "{}", said(&output));
    assert!(!said(&output).contains("unknown-key"), "{}", said(&output));
    assert!(results(scratch.path()) == whole);
    deck["solver_settings"]["model_import_settings"]["restart_load_file_label"] = json!("0.7");
    std::fs::write(&path, deck.to_string()).expect("the deck");
    let output = zelus(scratch.path(), &["run", DECK]);
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("Structure__restart_files/Structure_0.7.rest"), "{}", said(&output));
}

/// The back stress, the time of creep and the axes of the material are saved: a run that begins with a saved step gives the same bits.
#[test]
fn the_history_of_laws_is_saved() {
    let laws = [
        (
            "SmallStrainKinematicPlasticityPlaneStrainVonMisesVonMises",
            json!({"YOUNG_MODULUS": 2e9, "POISSON_RATIO": 0.3, "YIELD_STRESS": 1e3, "KINEMATIC_HARDENING_TYPE": 1,
             "KINEMATIC_PLASTICITY_PARAMETERS": [1e9, 1e3], "ISOTROPIC_HARDENING_MODULUS": 1e8}),
        ),
        (
            "SmallStrainNortonCreepPlaneStrain",
            json!({"YOUNG_MODULUS": 2e9, "POISSON_RATIO": 0.3, "NORTON_COEFFICIENT": 1e-15, "NORTON_EXPONENT": 3.0,
             "NORTON_TIME_EXPONENT": -0.3}),
        ),
        (
            "LinearElasticOrthotropicPlaneStrain2DLaw",
            json!({"YOUNG_MODULUS_X": 2e9, "YOUNG_MODULUS_Y": 1e9, "YOUNG_MODULUS_Z": 1e9, "POISSON_RATIO_XY": 0.3,
             "POISSON_RATIO_YZ": 0.2, "POISSON_RATIO_XZ": 0.3, "SHEAR_MODULUS_XY": 4e8}),
        ),
    ];
    for (law, variables) in laws {
        let scratch = deck("cases/structural/bar_plane_strain", 10, |deck| {
            let process = |name: &str, parameters: Value| json!({"python_module": name, "Parameters": parameters});
            let processes = &mut deck["processes"];
            processes["loads_process_list"][0]["Parameters"]["modulus"] = json!("2000*(1-3*t*(1-t))");
            processes["json_output_process_list"][0]["Parameters"]["gauss_points_output_variables"] =
                json!(["CAUCHY_STRESS_VECTOR"]);
            if law.contains("Orthotropic") {
                let parameters = json!({"model_part_name": "Structure", "update_at_each_step": true,
                    "cylindrical_generatrix_point": [-3.0, -2.0, 0.0]});
                processes["axes"] = json!([process("set_cylindrical_local_axes_process", parameters)]);
            }
            let saved = json!({"model_part_name": "Structure", "restart_save_frequency": 0.45});
            deck["output_processes"] = json!({"saved": [process("save_restart_process", saved)]});
        });
        let path = scratch.path().join("StructuralMaterials.json");
        let mut materials = read_json(&path).expect("the materials");
        materials["properties"][0]["Material"]["constitutive_law"]["name"] = json!(law);
        materials["properties"][0]["Material"]["Variables"] = variables;
        std::fs::write(&path, materials.to_string()).expect("the materials");
        let output = zelus(scratch.path(), &["run", DECK]);
        assert!(output.status.success(), "{law}: {}", said(&output));
        let whole = results(scratch.path());
        let path = scratch.path().join(DECK);
        let mut deck = read_json(&path).expect("the deck");
        deck["solver_settings"]["model_import_settings"] =
            json!({"input_type": "rest", "input_filename": "Structure", "restart_load_file_label": "0.5"});
        std::fs::write(&path, deck.to_string()).expect("the deck");
        let output = zelus(scratch.path(), &["run", DECK]);
        assert!(output.status.success(), "{law}: {}", said(&output));
        assert!(said(&output).contains("step 6,") && !said(&output).contains("step 5,"), "{law}: {}", said(&output));
        assert!(results(scratch.path()) == whole, "{law}");
    }
}

#[test]
fn settings_that_save_nothing_are_refused() {
    for (key, value) in [("max_files_to_keep", json!(0)), ("restart_save_frequency", json!(-1.0))] {
        let folder = deck("cases/contact_2d/friction_slide", 2, |deck| {
            deck["output_processes"] = json!({"saved": [{"python_module": "save_restart_process",
                "Parameters": {"model_part_name": "Structure", key: value}}]});
        });
        let output = zelus(folder.path(), &["run", DECK]);
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        assert!(said(&output).contains(key), "{}", said(&output));
    }
}

/// A run that is asked to go on begins anew where nothing was saved, and only there.
#[test]
fn names_of_saved_runs_that_lead_nowhere_are_refused() {
    let folder = deck("cases/contact_2d/friction_slide", 2, |_| {});
    let pointer = folder.path().join("ProjectParameters.resume");
    let resume = || zelus(folder.path(), &["run", DECK, "--resume"]);
    assert!(resume().status.success());
    let whole = contents(folder.path());
    assert!(Command::new("mkfifo").arg(folder.path().join("pipe")).status().expect("mkfifo").success());
    for name in [&b"\xff\xfe"[..], b"", b"\n", b"gone.rest", b"mesh.mdpa", b"/dev/zero", b"pipe", b"."] {
        std::fs::write(&pointer, name).expect("a file");
        let output = resume();
        assert_eq!(output.status.code(), Some(2), "{name:?}: {}", said(&output));
        assert!(said(&output).contains("[saved-run]"), "{}", said(&output));
    }
    [&pointer, &folder.path().join("pipe")].into_iter().for_each(|path| std::fs::remove_file(path).expect("a file"));
    assert!(contents(folder.path()) == whole, "files have changed");
}

/// A run with a file that has changed since it was saved does not go on, and says which.
#[test]
fn changed_materials_and_tables_are_refused_by_name() {
    for (case, file, find, with) in [
        ("cases/contact_2d/friction_slide", "StructuralMaterials.json", "1000000000.0", "2000000000.0"),
        ("cases/structural/load_table", "load.csv", "2.0,3.0e6", "2.0,4.0e6"),
    ] {
        let saving = |deck: &mut Value| {
            deck["output_processes"] = json!({"saved": [{"python_module": "save_restart_process",
                "Parameters": {"model_part_name": "Structure", "restart_control_type": "step", "restart_save_frequency": 1}}]});
        };
        let scratch = deck(case, 3, saving);
        let output = zelus(scratch.path(), &["run", DECK]);
        assert!(output.status.success(), "{}", said(&output));
        let output = zelus(scratch.path(), &["run", DECK, "--resume"]);
        assert!(output.status.success(), "unchanged: {}", said(&output));
        support::change(scratch.path(), file, find, with);
        let output = zelus(scratch.path(), &["run", DECK, "--resume"]);
        let told = said(&output);
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains("error[saved-run]") && told.contains(&format!("{file} has changed since")), "{told}");
    }
}

/// A run saves itself every `autosave_minutes`, goes on from there when it is killed, and leaves nothing when it comes to its end.
#[test]
fn a_run_saves_itself_now_and_then() {
    let motion = |minutes: f64| {
        deck("decks/bouncing_block", 350, move |deck| deck["problem_data"]["autosave_minutes"] = json!(minutes))
    };
    let saved = |folder: &Path| folder.join("ProjectParameters.rest").exists();
    for (minutes, saves) in [(1e-6, true), (0.0, false)] {
        let folder = motion(minutes);
        let output = zelus(folder.path(), &["run", DECK]);
        assert!(output.status.success() && !saved(folder.path()), "{}", said(&output));
        assert_eq!(said(&output).contains("in case the run is killed"), saves, "{}", said(&output));
    }
    let folder = motion(1e-6);
    let mut child = start(folder.path(), &["run", DECK, "-q"]);
    for _ in 0..2000 {
        if saved(folder.path()) && folder.path().join("ProjectParameters.resume").exists() {
            break;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().expect("a kill");
    child.wait().expect("an end");
    assert!(saved(folder.path()), "it was saved");
    let output = zelus(folder.path(), &["run", DECK, "--resume"]);
    assert!(output.status.success() && said(&output).contains("restart from"), "{}", said(&output));
    let whole = motion(0.0);
    assert!(zelus(whole.path(), &["run", DECK]).status.success());
    assert_same("autosave", whole.path(), folder.path());
}
