//! Output of a run: how much, where, and once more at the end.

use crate::support;
use std::path::Path;
use std::process::Command;

use crate::support::{change, read_json, root, said, scratch_copy, zelus};

const DECK: &str = "ProjectParameters.json";

/// A deck with a key that nothing reads, which is a warning.
fn deck_with_a_warning() -> tempfile::TempDir {
    let folder = scratch_copy(&root().join("tests/cases/contact_2d/matching"));
    change(folder.path(), DECK, "\"problem_name\"", "\"unheard_of\": 1, \"problem_name\"");
    folder
}

fn run(folder: &Path, options: &[&str]) -> String {
    let output = zelus(folder, &[&["run", DECK], options].concat());
    assert!(output.status.success(), "{}", said(&output));
    said(&output)
}

#[test]
fn quiet_says_warnings_only_and_verbose_says_who_solved() {
    let folder = deck_with_a_warning();
    let quiet = run(folder.path(), &["-q"]);
    assert!(quiet.starts_with("warning["), "{quiet}");
    assert!(quiet.lines().count() == 2 && quiet.contains("unheard_of"), "{quiet}");
    let usual = run(folder.path(), &[]);
    assert!(usual.contains("step 1, time") && !usual.contains("relative residual"), "{usual}");
    let verbose = run(folder.path(), &["-v"]);
    for word in ["step 1, time", "relative residual", "linear: factor: ", "total: "] {
        assert!(verbose.contains(word), "{word}:\n{verbose}");
    }
}

#[test]
fn warnings_are_said_again_at_the_end() {
    let folder = deck_with_a_warning();
    let text = run(folder.path(), &[]);
    let end = text.split_once("1 warning:\n").map_or("", |(_, end)| end);
    assert!(
        end.starts_with("  unknown-key-ignored: ProjectParameters.json:2:") && end.contains("unheard_of"),
        "{text}"
    );
    assert!(text.find("step 1").expect("a step") < text.find("1 warning:").expect("warnings"), "{text}");
}

#[test]
fn the_log_holds_all_that_is_said_also_of_a_run_that_fails() {
    let folder = deck_with_a_warning();
    assert!(!run(folder.path(), &["-q", "--log", "run.log"]).contains("step 1"));
    let read = || std::fs::read_to_string(folder.path().join("run.log")).expect("the log");
    let log = read();
    assert!(log.starts_with("zelus "), "{log}");
    for word in ["step 1, time", "relative residual", "warning[unknown-key-ignored]", "1 warning:", " converged in "] {
        assert!(log.contains(word), "{word}:\n{log}");
    }
    change(folder.path(), "mesh.mdpa", "SmallDisplacementElement2D4N", "TotalLagrangianElement2D4N");
    change(folder.path(), DECK, "\"value\": [null, 0.0, null]", "\"value\": [null, -1.0e200, null]");
    let output = zelus(folder.path(), &["run", DECK, "--log", "run.log", "--report", "run.json"]);
    assert!(!output.status.success(), "{}", said(&output));
    let error = String::from_utf8_lossy(&output.stderr);
    let last = error.lines().next().expect("an error");
    assert!(read().contains(last), "{last}\n{}", read());
    let report = read_json(&folder.path().join("run.json")).expect("the report");
    assert_eq!(report["exit_code"].as_i64(), output.status.code().map(i64::from));
    assert!(!report["errors"].as_array().expect("errors").is_empty());
}

#[test]
fn a_log_replaces_nothing_but_a_log() {
    let folder = deck_with_a_warning();
    let before = support::contents(folder.path());
    for (log, code) in [(DECK, 2), ("mesh.mdpa", 2), ("nowhere/run.log", 4)] {
        let output = zelus(folder.path(), &["run", DECK, "--log", log]);
        assert_eq!(output.status.code(), Some(code), "{log}: {}", said(&output));
        assert_eq!(support::contents(folder.path()), before, "{log}");
    }
}

/// `script` of util-linux gives the program a terminal.
#[test]
fn a_terminal_shows_the_step_of_how_many() {
    if !Command::new("script").arg("--version").output().is_ok_and(|output| output.status.success()) {
        println!("skipped: no `script` (util-linux), which makes a terminal");
        return;
    }
    let folder = scratch_copy(&root().join("examples/hertz_line_contact"));
    let line = format!("{} run {DECK}", env!("CARGO_BIN_EXE_zelus"));
    let mut command = Command::new("script");
    let output = command.args(["-qec", &line, "/dev/null"]).current_dir(folder.path()).output().expect("a terminal");
    let text = said(&output);
    assert!(output.status.success() && text.contains("step 2 of 4, 25 %") && text.contains(" left"), "{text}");
    let plain = zelus(folder.path(), &["run", DECK]);
    assert!(!said(&plain).contains(" of 4") && !said(&plain).contains('\r'), "{}", said(&plain));
}
