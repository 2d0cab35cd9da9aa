//! `--set` replaces the values of a deck, and is checked as if they stood in the deck.

use crate::support::{read_json, root, said, scratch_copy, zelus};

#[test]
fn values_of_the_command_line_take_the_place_of_the_deck_s() {
    let scratch = scratch_copy(&root().join("examples/hertz_line_contact"));
    let load = "processes.loads_process_list.0.Parameters.modulus";
    let run = |modulus: &str| {
        let set = format!("{load}={modulus}");
        let arguments = ["run", "ProjectParameters.json", "--set", &set, "--set", "problem_data.end_time=0.25"];
        let output = zelus(scratch.path(), &[&arguments[..], &["--report", "run.json"]].concat());
        assert!(output.status.success(), "{}", said(&output));
        let report = read_json(&scratch.path().join("run.json")).unwrap();
        assert_eq!(report["steps"].as_array().unwrap().len(), 1);
        let results = read_json(&scratch.path().join("contact_pressure.json")).unwrap();
        results.to_string()
    };
    assert_eq!(run("18.0*t"), run("\"18.0*t\""));
    assert_ne!(run("18.0*t"), run("9.0*t"));
}

#[test]
fn completions_and_the_manual_know_every_command() {
    for arguments in [&["completions", "bash"][..], &["completions", "zsh"], &["manual"]] {
        let output = zelus(&root(), arguments);
        assert!(output.status.success(), "{}", said(&output));
        for command in ["run", "check", "import", "convert", "new", "partition", "diff", "report", "describe"] {
            assert!(said(&output).contains(command), "{arguments:?} does not know {command}");
        }
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let scratch = scratch_copy(&root().join("examples/hertz_line_contact"));
    for (set, fact) in [
        ("solver_settings.max_iteration=many", "max_iteration must be an integer"),
        ("solver_setting.max_iteration=20", "there is no \"solver_setting\" in the deck"),
        ("processes.loads_process_list.7.help=x", "is a list of 1 and has no \"7\""),
        ("problem_data.end_time.x=1", "which holds nothing"),
        ("problem_data.end_time", "has no value"),
        ("solver_settings.max_iterations=20", "\"max_iterations\" is not a setting of Static"),
    ] {
        let output = zelus(scratch.path(), &["check", "ProjectParameters.json", "--set", set]);
        assert_eq!(output.status.code(), Some(2), "{set}: {}", said(&output));
        assert!(said(&output).contains(fact), "{set}: {}", said(&output));
    }
}
