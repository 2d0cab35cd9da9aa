//! Steps that fail are cut, grow back, and leave no trace of the attempts that failed.

use crate::support::{change, contents, read_json, root, said, scratch_copy, zelus};
use std::path::{Path, PathBuf};

const DECK: &str = "ProjectParameters.json";

/// Runs a changed deck: exit code, output, accepted times, number of attempts, result files.
struct Run {
    code: Option<i32>,
    text: String,
    lengths: Vec<f64>,
    attempts: usize,
    results: Vec<(PathBuf, Vec<u8>)>,
}

fn run(folder: &Path, changes: &[(&str, &str, &str)]) -> Run {
    let scratch = scratch_copy(folder);
    for (file, find, with) in changes {
        change(scratch.path(), file, find, with);
    }
    let before = contents(scratch.path());
    let output = zelus(scratch.path(), &["run", DECK, "--report", "report.json"]);
    let report = read_json(&scratch.path().join("report.json")).expect("a report");
    let steps = report["steps"].as_array().expect("steps");
    let accepted = steps.iter().filter(|step| step["converged"] == true);
    let results = contents(scratch.path())
        .into_iter()
        .filter(|(name, _)| !before.contains_key(name) && name.file_name().is_some_and(|name| name != "report.json"));
    Run {
        code: output.status.code(),
        text: said(&output),
        lengths: accepted.map(|step| step["delta_time"].as_f64().expect("a length")).collect(),
        attempts: steps.len(),
        results: results.collect(),
    }
}

/// A rule of `time_stepping` that gives steps of these lengths.
fn as_intervals(lengths: &[f64]) -> String {
    let mut begin = 0.0;
    let mut rules = Vec::new();
    for (at, length) in lengths.iter().enumerate() {
        let end = begin + 0.5 * length;
        rules.push(format!("\"{at}\": {{\"interval\": [{begin:e}, {end:e}], \"time_step\": {length:e}}}"));
        begin += length;
    }
    format!("\"time_step_intervals\": {{{}}}", rules.join(", "))
}

fn assert_same_bits(cut: &Run, given: &Run) {
    assert!(cut.attempts > given.attempts, "no step was cut");
    assert_eq!(given.attempts, given.lengths.len(), "{}", given.text);
    assert_eq!(cut.lengths, given.lengths);
    assert!(!cut.results.is_empty());
    for ((name, cut), (_, given)) in cut.results.iter().zip(&given.results) {
        assert!(cut == given, "{} differs", name.display());
    }
}

/// A deck that gives the lengths found by cutting ends with the same bits: changes by failed attempts are put back.
#[test]
fn the_state_before_a_failed_attempt_comes_back_to_the_bit() {
    let folder = root().join("tests/decks/oscillator");
    let elements = ("mesh.mdpa", "SmallDisplacementElement2D4N", "TotalLagrangianElement2D4N");
    let few = (
        DECK,
        "\"max_iteration\": 10",
        "\"max_iteration\": 3, \"continue_if_converging\": false, \"line_search_after_failure\": false",
    );
    let end = (DECK, "\"end_time\": 1.0", "\"end_time\": 2.0");
    for scheme in ["newmark", "bossak", "generalized_alpha", "bdf2", "bdf3"] {
        let name = format!("\"scheme_type\": \"{scheme}\"");
        let scheme = (DECK, "\"scheme_type\": \"newmark\"", name.as_str());
        let cut = run(&folder, &[elements, few, end, scheme, (DECK, "\"time_step\": 0.1", "\"time_step\": 1.0")]);
        assert_eq!(cut.code, Some(0), "{}", cut.text);
        let rules = as_intervals(&cut.lengths);
        let given = run(&folder, &[elements, few, end, scheme, (DECK, "\"time_step\": 0.1", &rules)]);
        assert_same_bits(&cut, &given);
    }
}

#[test]
fn contact_with_friction_comes_back_to_the_bit() {
    let folder = root().join("tests/cases/contact_3d/friction_tresca_slide");
    let few = (
        DECK,
        "\"max_iteration\": 30",
        "\"max_iteration\": 3, \"continue_if_converging\": false, \"line_search_after_failure\": false",
    );
    let cut = run(&folder, &[few]);
    assert_eq!(cut.code, Some(0), "{}", cut.text);
    let rules = as_intervals(&cut.lengths);
    let given = run(&folder, &[few, (DECK, "\"time_step\": 0.2", &rules)]);
    assert_eq!(given.code, Some(0), "{}", given.text);
    assert_same_bits(&cut, &given);
}

#[test]
fn contact_settings_say_how_steps_are_cut() {
    let folder = root().join("tests/cases/contact_2d/friction_slide");
    let few = (
        DECK,
        "\"max_iteration\": 30",
        "\"max_iteration\": 2, \"continue_if_converging\": false, \"line_search_after_failure\": false",
    );
    let splits = "\"adaptative_strategy\": true, \"split_factor\": 4.0, \"max_number_splits\": 1, \"mortar_type\"";
    let cut = run(&folder, &[few, (DECK, "\"mortar_type\"", splits)]);
    assert_eq!((cut.code, cut.attempts), (Some(3), 2), "{}", cut.text);
    assert!(
        cut.text.contains("retried with 1/4 of the step") && cut.text.contains("1 cut of the step by 4"),
        "{}",
        cut.text
    );
    let none = run(&folder, &[few, (DECK, "\"time_stepping\"", "\"step_cutting\": false, \"time_stepping\"")]);
    assert_eq!((none.code, none.attempts), (Some(3), 1), "{}", none.text);
    assert!(none.text.contains("the solver does not cut steps"), "{}", none.text);
}

/// After cuts the steps grow back to the deck's.
#[test]
fn steps_grow_back_after_a_cut() {
    let folder = root().join("tests/decks/squeezed_block");
    let newton = (DECK, "\"type\": \"line_search\"", "\"type\": \"newton_raphson\"");
    let few = (
        DECK,
        "\"max_iteration\": 30",
        "\"max_iteration\": 5, \"continue_if_converging\": false, \"line_search_after_failure\": false",
    );
    let cut = run(&folder, &[newton, few, (DECK, "\"end_time\": 1.0", "\"end_time\": 3.0")]);
    assert_eq!(cut.code, Some(0), "{}", cut.text);
    assert!(cut.lengths[0] < 1.0 && cut.lengths.last() == Some(&1.0), "{:?}", cut.lengths);
}
