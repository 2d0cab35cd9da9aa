//! Files that a run must not destroy: its inputs, results of earlier runs, files of strangers, outputs of another run.

use std::fs::{self, File};
use std::path::Path;
use std::process::Command;

use crate::support::{contents, read_json, root, said, scratch_copy, zelus};
use serde_json::{Value, json};

const DECK: &str = "ProjectParameters.json";

/// The deck of a case, edited, in a folder of its own below a scratch folder.
fn deck(edit: impl Fn(&mut Value)) -> tempfile::TempDir {
    let scratch = scratch_copy(&root().join("tests/cases/contact_2d/matching"));
    let path = scratch.path().join(DECK);
    let mut deck = read_json(&path).expect("JSON");
    edit(&mut deck);
    fs::write(&path, deck.to_string()).expect("the deck");
    scratch
}

fn json_output(deck: &mut Value) -> &mut Value {
    &mut deck["processes"]["json_output_process_list"][0]["Parameters"]["output_file_name"]
}

fn pictures(deck: &mut Value, folder: &str) {
    let parameters = json!({"model_part_name": "Structure", "output_path": folder});
    deck["output_processes"] = json!({"vtu": [{"python_module": "vtu_output_process", "Parameters": parameters}]});
}

/// The upper body is pulled off, and nothing holds it.
fn fails(deck: &mut Value) {
    deck["processes"]["loads_process_list"][0]["Parameters"]["modulus"] = json!(-1e6);
    deck["solver_settings"]["step_cutting"] = json!(false);
}

/// Runs a deck that must be refused before anything happens: exit 2, these words, and every file as it was.
fn is_refused(folder: &Path, arguments: &[&str], words: &str) {
    let before = contents(folder);
    let output = zelus(folder, &[&["run", DECK], arguments].concat());
    let said = said(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("[output-file]") && said.contains(words), "{words}: {said}");
    assert!(said.contains("nothing was run"), "{said}");
    assert!(contents(folder) == before, "files have changed: {said}");
}

#[test]
fn inputs_are_no_outputs() {
    let plain = deck(|_| {});
    fs::write(plain.path().join("notes.txt"), "mine").expect("a file");
    is_refused(plain.path(), &["--report", DECK], "is read by the run");
    is_refused(plain.path(), &["--report", "mesh.mdpa"], "is nothing that an earlier run");
    is_refused(plain.path(), &["--report", "notes.txt"], "is nothing that an earlier run");
    is_refused(plain.path(), &["--report", "/dev/null"], "no file");
    is_refused(plain.path(), &["--report", "lower.json"], "is written twice");
    for name in ["mesh.mdpa", "StructuralMaterials.json", DECK, "./mesh.mdpa"] {
        let scratch = deck(|deck| *json_output(deck) = json!(name));
        is_refused(scratch.path(), &[], "is read by the run");
    }
    // Files of others, whatever writes there.
    let strange = |name: &str, edit: &dyn Fn(&mut Value)| {
        let scratch = deck(edit);
        let path = scratch.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, "{\"mine\": 1}").expect("a file");
        is_refused(scratch.path(), &[], "is nothing that an earlier run has written");
    };
    strange("upper.json", &|_| {});
    strange("pictures/Structure_7.vtu", &|deck| pictures(deck, "pictures"));
    strange("pictures/Structure_0_7.vtk", &|deck| {
        pictures(deck, "pictures");
        deck["output_processes"]["vtu"][0]["python_module"] = json!("vtk_output_process");
    });
    strange("point.dat", &|deck| {
        let parameters = json!({"model_part_name": "Structure", "position": [0.0, 0.0, 0.0], "output_file_settings":
            {"file_name": "point.dat"}, "output_variables": ["DISPLACEMENT"]});
        deck["output_processes"] = json!({"p": [{"python_module": "point_output_process", "Parameters": parameters}]});
    });
    strange("Structure__restart_files/Structure_1.rest", &|deck| {
        let parameters = json!({"model_part_name": "Structure"});
        deck["output_processes"] = json!({"s": [{"python_module": "save_restart_process", "Parameters": parameters}]});
    });
    let twice = deck(|deck| *json_output(deck) = json!("upper.json"));
    is_refused(twice.path(), &[], "is written twice");
    let long = deck(|deck| *json_output(deck) = json!("x".repeat(300)));
    is_refused(long.path(), &[], "too long");
    let below = deck(|deck| *json_output(deck) = json!("mesh.mdpa/results.json"));
    is_refused(below.path(), &[], "is no folder");
}

#[test]
fn partitions_replace_no_files_of_others() {
    let plain = deck(|_| {});
    let before = contents(plain.path());
    for (option, name) in [("--json", "mesh.mdpa"), ("--vtu", "mesh.mdpa"), ("--json", DECK), ("--vtu", "/dev/null")] {
        let output = zelus(plain.path(), &["partition", DECK, "--ranks", "2", option, name]);
        assert_eq!(output.status.code(), Some(2), "{option} {name}: {}", said(&output));
        assert!(said(&output).contains("[output-file]"), "{}", said(&output));
        assert!(contents(plain.path()) == before, "{option} {name}");
    }
    for _ in 0..2 {
        let arguments = ["partition", DECK, "--ranks", "2", "--json", "ranks.json", "--vtu", "ranks.vtu"];
        let output = zelus(plain.path(), &arguments);
        assert!(output.status.success(), "{}", said(&output));
    }
}

/// A limit of the size of files is an error that is told, and no silent end.
#[test]
fn limits_of_files_are_told() {
    let plain = deck(|_| {});
    let program = env!("CARGO_BIN_EXE_zelus");
    let limited = format!("ulimit -f 1; exec {program} run {DECK}");
    let output = Command::new("bash").args(["-c", &limited]).current_dir(plain.path()).output().expect("a shell");
    let code = output.status.code();
    assert!(matches!(code, Some(2 | 4)) && said(&output).contains("File too large"), "{code:?}: {}", said(&output));
}

/// A disk with room for the probe of nothing is refused; one that fills up while a run writes ends it with a message, and complete
/// files stay.
#[test]
fn full_disks_are_told() {
    let run = |kilobytes: usize, steps: usize| {
        let scratch = deck(|deck| {
            pictures(deck, "disk/pictures");
            deck["problem_data"]["end_time"] = json!(steps);
            deck["processes"].as_object_mut().expect("lists").remove("json_output_process_list");
        });
        let (program, folder) = (env!("CARGO_BIN_EXE_zelus"), scratch.path().display());
        let script = format!(
            "mkdir disk && mount -t tmpfs -o size={kilobytes}k none disk || exit 77; {program} run {DECK}; code=$?; \
             ls disk/pictures > {folder}/left; cp -r disk/pictures {folder}/seen; exit $code"
        );
        let words = ["-rm", "bash", "-c", &script];
        let output = Command::new("unshare").args(words).current_dir(scratch.path()).output();
        output.ok().filter(|output| !matches!(output.status.code(), Some(1 | 77))).map(|output| (scratch, output))
    };
    let Some((_scratch, output)) = run(40, 1) else {
        println!("skipped: this machine makes no file systems for users");
        return;
    };
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("No space left") && said(&output).contains("nothing was run"), "{}", said(&output));
    let (scratch, output) = run(100, 200).expect("it was made before");
    assert_eq!(output.status.code(), Some(4), "{}", said(&output));
    assert!(said(&output).contains("No space left"), "{}", said(&output));
    let seen = contents(&scratch.path().join("seen"));
    let pictures = seen.iter().filter(|(name, _)| name.extension().is_some_and(|ending| ending == "vtu"));
    let whole = pictures.filter(|(_, text)| text.trim_ascii_end().ends_with(b"</VTKFile>")).count();
    assert!(whole > 3, "{whole} pictures stay");
    let names = seen.keys().map(|name| name.to_string_lossy());
    assert!(names.into_iter().all(|name| !name.ends_with(".part")), "halves of files stay");
}

#[test]
fn links_are_followed() {
    let scratch = deck(|_| {});
    fs::write(scratch.path().join("real.json"), "{\"TIME\": []}").expect("a file");
    std::os::unix::fs::symlink("real.json", scratch.path().join("lower.json")).expect("a link");
    let output = zelus(scratch.path(), &["run", DECK]);
    assert!(output.status.success(), "{}", said(&output));
    let link = fs::symlink_metadata(scratch.path().join("lower.json")).expect("the link");
    assert!(link.is_symlink(), "the link is replaced");
    assert!(read_json(&scratch.path().join("real.json")).expect("results")["TIME"].is_array());
}

/// A run whose first step fails leaves every result of the one before; one that makes a step takes its pictures away.
#[test]
fn results_stay_until_there_are_others() {
    let scratch = deck(|deck| pictures(deck, "pictures"));
    let (folder, pictures) = (scratch.path(), scratch.path().join("pictures"));
    fs::create_dir(&pictures).expect("a folder");
    fs::write(pictures.join("Structure_99.vtu"), "<?xml of an earlier run").expect("a file");
    fs::write(pictures.join("Other_1.vtu"), "of a stranger").expect("a file");
    for file in ["lower.json", "upper.json", "slave.json"] {
        fs::write(folder.join(file), "{\"TIME\": [7.0]}").expect("a file");
    }
    let text = fs::read_to_string(folder.join(DECK)).expect("the deck");
    let mut pulled: Value = serde_json::from_str(&text).expect("JSON");
    fails(&mut pulled);
    fs::write(folder.join(DECK), pulled.to_string()).expect("the deck");
    let before = contents(folder);
    let output = zelus(folder, &["run", DECK]);
    assert_eq!(output.status.code(), Some(4), "{}", said(&output));
    let mut after = contents(folder);
    after.retain(|path, _| !path.starts_with("pictures_last_iterate"));
    assert!(after == before, "{}", said(&output));

    fs::write(folder.join(DECK), text).expect("the deck");
    let output = zelus(folder, &["run", DECK]);
    assert!(output.status.success(), "{}", said(&output));
    let mut names: Vec<String> = contents(&pictures).into_keys().map(|name| name.display().to_string()).collect();
    names.sort();
    assert_eq!(names, ["Other_1.vtu", "Structure.pvd", "Structure_0.vtu", "Structure_1.vtu"]);
}

#[test]
fn two_runs_do_not_write_one_file() {
    let scratch = deck(|_| {});
    let lock = scratch.path().join(".upper.json.lock");
    let held = File::create(&lock).expect("a lock");
    held.lock().expect("the lock");
    let output = zelus(scratch.path(), &["run", DECK]);
    assert_eq!(output.status.code(), Some(4), "{}", said(&output));
    assert!(said(&output).contains("upper.json is being written by another run"), "{}", said(&output));
    drop(held);
    fs::write(scratch.path().join(".upper.json.4194999.part"), "left by a killed run").expect("a file");
    let output = zelus(scratch.path(), &["run", DECK]);
    assert!(output.status.success(), "{}", said(&output));
    let hidden: Vec<_> = contents(scratch.path()).into_keys().filter(|name| name.starts_with(".")).collect();
    assert!(hidden.is_empty(), "{hidden:?}");
    let names: Vec<String> = contents(scratch.path()).into_keys().map(|name| name.display().to_string()).collect();
    assert!(!names.iter().any(|name| name.ends_with(".lock") || name.ends_with(".part")), "{names:?}");
}

#[test]
fn reports_hold_why_a_run_ended() {
    let report = |edit: &dyn Fn(&mut Value), exit: i32| {
        let scratch = deck(edit);
        let output = zelus(scratch.path(), &["run", DECK, "--report", "report.json"]);
        assert_eq!(output.status.code(), Some(exit), "{}", said(&output));
        read_json(&scratch.path().join("report.json")).expect("the report")
    };
    let good = report(&|_| {}, 0);
    assert_eq!((&good["exit_code"], &good["errors"]), (&json!(0), &json!([])));
    let bad = report(&|deck| deck["solver_settings"]["solver_type"] = json!("Sttic"), 2);
    assert!(bad["exit_code"] == 2 && bad["errors"][0].as_str().is_some_and(|error| error.contains("Sttic")), "{bad}");
    let failed = report(&fails, 4);
    assert!(
        failed["exit_code"] == 4 && failed["errors"].as_array().is_some_and(|errors| errors.len() == 1),
        "{failed}"
    );
}
