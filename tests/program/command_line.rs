//! The program as a user meets it: commands, exit codes, the report, and the same results with any number of threads.

use crate::support;
use crate::support::{Results, contents, read_json, root, said, scratch_copy, zelus};
use std::path::Path;

fn case(name: &str) -> tempfile::TempDir {
    scratch_copy(&root().join("tests/cases").join(name))
}

/// Replaces a text in the deck's project parameters.
fn change(folder: &Path, find: &str, with: &str) {
    let path = folder.join("ProjectParameters.json");
    let text = std::fs::read_to_string(&path).expect("the deck");
    assert!(text.contains(find), "the deck does not have {find:?}");
    std::fs::write(path, text.replace(find, with)).expect("the deck");
}

#[test]
fn list_shows_what_decks_can_name() {
    let output = zelus(&root(), &["list", "all"]);
    assert!(output.status.success(), "{}", said(&output));
    let text = String::from_utf8_lossy(&output.stdout);
    for name in
        ["SmallDisplacementElement2D4N", "LinearElastic3DLaw", "alm_contact_process", "contact_residual_criterion"]
    {
        assert!(text.contains(name), "{name} is not in the list");
    }
    let output = zelus(&root(), &["list", "process"]);
    assert!(output.status.success(), "{}", said(&output));
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.contains("alm_contact_process") && !text.contains("SmallDisplacementElement2D4N"), "{text}");
}

/// The overview fits a screen and names every kind; conditions that contact makes are one line of their kind.
#[test]
fn the_list_is_short_and_grouped() {
    let list = |word: &[&str]| {
        let output = zelus(&root(), &[&["list"], word].concat());
        assert!(output.status.success(), "{}", said(&output));
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let (overview, all) = (list(&[]), list(&["all"]));
    assert!(overview.lines().count() < 50 && overview.lines().all(|line| line.chars().count() < 140), "{overview}");
    for kind in all.lines().filter(|line| !line.starts_with(' ')).filter_map(|line| line.split(" (").next()) {
        assert!(overview.contains(&format!("\n  {kind} (")), "no {kind} in\n{overview}");
    }
    assert!(!overview.contains("Mortar") && all.contains("ALMFrictionalMortarContactCondition3D4N"));
    let conditions = list(&["condition"]);
    assert!(conditions.lines().count() < 40 && conditions.contains("SurfaceLoadCondition 3D3N, 3D4N"), "{conditions}");
    assert!(conditions.contains("conditions of pairs of facets"), "{conditions}");
    let contact = list(&["contact"]);
    for word in ["docs/contact.md", "alm_contact_process", "ALMContactFrictional", "contact_residual_criterion"] {
        assert!(contact.contains(word), "no {word} in\n{contact}");
    }
}

#[test]
fn subjects_lead_to_names_and_a_page() {
    for (word, name, page) in [
        ("bolt", "bolt_pretension_process", "docs/boundary-conditions.md#bolts"),
        ("torque", "distribute_resultant_on_part_process", "docs/boundary-conditions.md#loads-by-resultant"),
        ("friction", "friction_coefficients", "docs/contact.md#friction"),
        ("Restart", "save_restart_process", "docs/restart.md"),
        ("press-fit", "initial_clearance_process", "docs/contact.md#clearance-by-number"),
        (
            "sector",
            "apply_periodic_condition_process",
            "docs/boundary-conditions.md#cyclic-symmetry-and-periodic-conditions",
        ),
        ("springs", "GroundSpringCondition", ""),
    ] {
        let output = zelus(&root(), &["describe", word]);
        assert!(output.status.success(), "{}", said(&output));
        let text = String::from_utf8_lossy(&output.stdout);
        assert!(text.contains(name) && text.contains(page), "{word}: {text}");
    }
}

/// Every command with its options, as their help shows them.
#[test]
fn the_manual_has_the_options_of_every_command() {
    let output = zelus(&root(), &["manual"]);
    let manual = String::from_utf8_lossy(&output.stdout).replace("\\-", "-");
    let help = String::from_utf8_lossy(&zelus(&root(), &["--help"]).stdout).into_owned();
    let (_, commands) = help.split_once("Commands:\n").expect("commands");
    let commands = commands.lines().take_while(|line| !line.is_empty());
    let commands: Vec<&str> = commands.filter_map(|line| line.split_whitespace().next()).collect();
    assert!(commands.len() > 10, "{commands:?}");
    for command in commands.into_iter().filter(|command| *command != "help") {
        let section = manual.split(".SH ").find(|own| own.starts_with(&format!("ZELUS {}\n", command.to_uppercase())));
        let section = section.unwrap_or_else(|| panic!("no section of {command}"));
        let help = String::from_utf8_lossy(&zelus(&root(), &[command, "--help"]).stdout).into_owned();
        for option in help.split_whitespace().filter(|word| word.starts_with("--") && word.len() > 2) {
            let option = option.trim_end_matches([',', '.', ';', ')']).split('=').next().expect("a word");
            assert!(section.contains(option), "{command} has {option}, and its section has not:\n{section}");
        }
    }
}

/// Face pressures have opposite signs in the plane and in space: faces that pull are named, and faces that are listed both ways round.
#[test]
fn check_says_which_way_face_pressures_act() {
    let check = |folder: &Path| {
        let output = zelus(folder, &["check", "ProjectParameters.json"]);
        assert!(output.status.success(), "{}", said(&output));
        said(&output)
    };
    for (name, presses, pulls) in [
        (
            "elements/load_patch_2D4N",
            "\"NEGATIVE_FACE_PRESSURE\"",
            ["\"POSITIVE_FACE_PRESSURE\"", "\"POSITIVE_FACE_PRESSURE\""],
        ),
        ("elements/load_patch_3D4N", "\"POSITIVE_FACE_PRESSURE\"", ["\"NEGATIVE_FACE_PRESSURE\"", "\"PRESSURE\""]),
    ] {
        let scratch = case(name);
        assert!(!check(scratch.path()).contains("face-pressure"), "{name}");
        for pulls in pulls {
            let scratch = case(name);
            change(scratch.path(), presses, pulls);
            let text = check(scratch.path());
            assert!(text.contains("note[face-pressure-pulls]") && text.contains("above zero pulls at all"), "{text}");
            change(scratch.path(), "\"value\": 1000.0", "\"value\": -1000.0");
            assert!(!check(scratch.path()).contains("face-pressure"), "{name} with {pulls}");
        }
    }
    let scratch = case("elements/load_patch_2D4N");
    support::change(scratch.path(), "mesh.mdpa", "3 0 8 7\n", "3 0 7 8\n");
    let text = check(scratch.path());
    assert!(
        text.contains("warning[face-pressure-mixed]") && text.contains("presses on 1 face and pulls at 1"),
        "{text}"
    );
}

#[test]
fn describe_shows_settings_with_defaults() {
    let output = zelus(&root(), &["describe", "alm_contact_process"]);
    assert!(output.status.success(), "{}", said(&output));
    let text = String::from_utf8_lossy(&output.stdout);
    for word in ["search_factor", "3.5", "active_check_factor", "contact_model_part"] {
        assert!(text.contains(word), "{word} is not described:\n{text}");
    }
}

#[test]
fn describe_and_list_help_with_unknown_names() {
    let output = zelus(&root(), &["describe", "alm_contact_proces"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("alm_contact_process"), "{}", said(&output));
    let output = zelus(&root(), &["list", "proces"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
}

#[test]
fn an_unknown_command_or_option_is_bad_input() {
    for arguments in [&["rum"][..], &["run"], &["run", "ProjectParameters.json", "--thread", "1"]] {
        let output = zelus(&root(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", said(&output));
    }
}

#[test]
fn check_accepts_a_good_deck_and_writes_nothing() {
    let scratch = case("contact_2d/nonmatching");
    let before = contents(scratch.path());
    let output = zelus(scratch.path(), &["check", "ProjectParameters.json"]);
    assert!(output.status.success(), "{}", said(&output));
    assert_eq!(contents(scratch.path()), before, "files were written");
}

#[test]
fn a_deck_runs_from_any_folder_beside_its_files() {
    let scratch = case("contact_2d/nonmatching");
    let elsewhere = tempfile::tempdir().expect("a folder");
    let deck = scratch.path().join("ProjectParameters.json");
    let output = zelus(elsewhere.path(), &["run", &deck.to_string_lossy()]);
    assert!(output.status.success(), "{}", said(&output));
    assert!(scratch.path().join("slave.json").is_file(), "results are not beside the deck");
    assert!(contents(elsewhere.path()).is_empty(), "files were written into the working folder");
}

#[test]
fn the_report_of_a_run_says_what_happened() {
    let scratch = case("contact_2d/opening");
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json", "--report", "report.json"]);
    assert!(output.status.success(), "{}", said(&output));
    let report = read_json(&scratch.path().join("report.json")).expect("a report");
    let text = report.to_string();
    assert!(text.contains(env!("CARGO_PKG_VERSION")), "no version in {text}");
    let steps = report["steps"].as_array().unwrap_or_else(|| panic!("no steps in {text}"));
    assert_eq!(steps.len(), 2, "{text}");
    for step in steps {
        assert_eq!(step["converged"], true, "{step}");
        assert!(step["iterations"].as_array().is_some_and(|i| !i.is_empty()), "{step}");
    }
    assert_eq!(report["converged"], true, "{text}");
    assert!(report["sizes"]["unknowns"].as_u64().is_some_and(|n| n > 0), "{text}");
    assert!(report["seconds"]["total"].as_f64().is_some_and(|s| s > 0.0), "{text}");
}

#[test]
fn a_report_that_cannot_be_written_is_a_system_failure() {
    let scratch = case("structural/bar_plane_stress");
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json", "--report", "no/such/folder/report.json"]);
    assert_eq!(output.status.code(), Some(4), "{}", said(&output));
    assert!(said(&output).contains("no/such/folder"), "{}", said(&output));
}

#[test]
fn a_step_that_does_not_converge_ends_the_run_with_what_was_accepted_before_it() {
    let scratch = case("contact_2d/opening");
    change(scratch.path(), "\"max_iteration\": 20", "\"max_iteration\": 1");
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json"]);
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
    let results = Results::read(&scratch.path().join("slave.json")).expect("the step accepted before");
    assert!(results.step(Some(1.0)).is_ok(), "the step that converged is missing");
    assert!(results.step(Some(2.0)).is_err(), "a step that did not converge was written");
    let text = said(&output);
    for word in
        ["step ", "in 1 iteration", "largest residual", "of node", "Try a shorter \"time_step\"", "results up to time"]
    {
        assert!(text.contains(word), "the message does not say {word:?}:\n{text}");
    }
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    for arguments in [&["list"][..], &["describe", "alm_contact_process"]] {
        let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_zelus"))
            .args(arguments)
            .stdout(std::process::Stdio::piped())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .expect("the program starts");
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("the program ends");
        assert!(output.status.success() && output.stderr.is_empty(), "{arguments:?}: {}", said(&output));
    }
}

#[test]
fn a_body_without_supports_is_a_solver_failure() {
    let scratch = case("structural/bar_plane_stress");
    change(scratch.path(), "\"constrained\": [true, false, false]", "\"constrained\": [false, false, false]");
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json"]);
    assert_eq!(output.status.code(), Some(4), "{}", said(&output));
}

#[test]
fn results_are_the_same_to_the_bit_with_one_and_two_threads() {
    let decks = [
        "tests/cases/contact_3d/hexahedra_nonmatching",
        "tests/cases/contact_2d/closing_gap",
        "examples/hertz_line_contact",
    ];
    for deck in decks {
        let runs = ["1", "2"].map(|threads| {
            let scratch = scratch_copy(&root().join(deck));
            let output = zelus(scratch.path(), &["run", "ProjectParameters.json", "--threads", threads]);
            assert!(output.status.success(), "{deck}: {}", said(&output));
            contents(scratch.path())
        });
        assert!(runs[0].keys().eq(runs[1].keys()), "{deck}: not the same files");
        for (name, content) in &runs[0] {
            assert!(*content == runs[1][name], "{deck}: {} depends on the number of threads", name.display());
        }
    }
}

#[test]
fn an_output_folder_that_is_a_file_is_refused() {
    let scratch = scratch_copy(&root().join("tests/program/bad_decks/good"));
    change(scratch.path(), "\"output_path\": \"vtk_output\"", "\"output_path\": \"mesh.mdpa\"");
    let mesh = std::fs::read(scratch.path().join("mesh.mdpa")).expect("the mesh");
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("mesh.mdpa"), "{}", said(&output));
    assert_eq!(std::fs::read(scratch.path().join("mesh.mdpa")).expect("the mesh"), mesh, "the mesh was written over");
}

#[test]
fn a_solver_key_that_contact_lets_pass_is_a_warning_with_a_name() {
    let scratch = scratch_copy(&root().join("tests/program/bad_decks/good"));
    change(scratch.path(), "\"max_iteration\"", "\"max_iterations\"");
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json"]);
    assert!(output.status.success(), "{}", said(&output));
    let text = said(&output);
    assert!(
        text.contains("warning") && text.contains("max_iterations") && text.contains("\"max_iteration\""),
        "{text}"
    );
}

#[test]
fn partition_gives_every_element_one_rank_and_says_what_it_costs() {
    let folder = case("contact_3d/hexahedra_nonmatching");
    let deck = "ProjectParameters.json";
    let output = zelus(folder.path(), &["partition", deck, "-n", "3", "--json", "cut.json", "--vtu", "cut.vtu"]);
    assert!(output.status.success(), "{}", said(&output));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    for word in ["neighbours", "held", "ghosts", "on all ranks", "mean", "imbalance", "faces cut", "far pairs"] {
        assert!(text.contains(word), "{word} is not said:\n{text}");
    }
    let cut = read_json(&folder.path().join("cut.json")).expect("the partition");
    let ranks: Vec<u64> = cut["elements"]["rank"].as_array().unwrap().iter().filter_map(|r| r.as_u64()).collect();
    assert_eq!(ranks.len(), cut["elements"]["ids"].as_array().unwrap().len());
    let counted: Vec<u64> = (0..3).map(|rank| cut["counts"]["ranks"][rank]["elements"].as_u64().unwrap()).collect();
    for rank in 0..3 {
        assert_eq!(ranks.iter().filter(|&&own| own == rank).count() as u64, counted[rank as usize]);
        assert!(counted[rank as usize] > 0);
    }
    let owned: u64 = (0..3).map(|rank| cut["counts"]["ranks"][rank]["nodes"].as_u64().unwrap()).sum();
    assert_eq!(owned, cut["nodes"]["ids"].as_array().unwrap().len() as u64);
    assert!(std::fs::read(folder.path().join("cut.vtu")).expect("the picture").windows(4).any(|w| w == b"RANK"));
    let again = zelus(folder.path(), &["partition", deck, "-n", "3", "--json", "again.json"]);
    assert!(again.status.success(), "{}", said(&again));
    assert_eq!(read_json(&folder.path().join("again.json")).expect("the partition"), cut);
}

#[test]
fn more_ranks_than_elements_are_bad_input() {
    let folder = case("contact_3d/hexahedra_nonmatching");
    for ranks in ["100000", "0"] {
        let output = zelus(folder.path(), &["partition", "ProjectParameters.json", "-n", ranks]);
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        assert!(said(&output).contains("cannot be shared by"), "{}", said(&output));
    }
}

/// The defaults of Kratos apply where a deck gives none, never over its own values, by option or by the deck's own word.
#[test]
fn defaults_of_kratos_fill_in_what_a_deck_leaves_out() {
    let folder = case("contact_2d/matching");
    let applied = |arguments: &[&str]| {
        let output =
            zelus(folder.path(), &[&["run", "ProjectParameters.json", "--report", "run.json"], arguments].concat());
        assert!(output.status.success(), "{}", said(&output));
        let report = read_json(&folder.path().join("run.json")).expect("the report");
        let settings: Vec<String> = serde_json::from_value(report["defaults_from_kratos"].clone()).expect("settings");
        (report["like"].as_str().map(str::to_owned), settings)
    };
    let normals = "alm_contact_process.normal_variation = \"no_derivatives_computation\"".to_owned();
    assert_eq!(applied(&[]), (None, vec![]));
    let (program, settings) = applied(&["--like", "kratos"]);
    assert_eq!(program.as_deref(), Some("kratos"));
    assert!(settings.contains(&normals), "{settings:?}");
    change(folder.path(), "\"problem_data\": {", "\"problem_data\": { \"like\": \"kratos\",");
    assert_eq!(applied(&[]), (program, settings));
    let normal = "\"normal_variation\": \"elemental_derivatives\", \"contact_type\"";
    change(folder.path(), "\"contact_type\"", normal);
    let (_, settings) = applied(&[]);
    assert!(!settings.contains(&normals), "{settings:?}");
    let output = zelus(folder.path(), &["check", "ProjectParameters.json", "--like", "kratoss"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("unknown-program") && said(&output).contains("kratos"), "{}", said(&output));
}

#[test]
fn a_program_in_python_is_sent_to_python() {
    let folder = case("elements/load_patch_2D4N");
    std::fs::write(folder.path().join("MainKratos.py"), "import KratosMultiphysics\n").expect("a program");
    let output = zelus(folder.path(), &["run", "MainKratos.py"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("`python -m zelus MainKratos.py` runs it"), "{}", said(&output));
}

/// The run ends at `end_time`, or with the whole step that a deck means by an end a little before it.
#[test]
fn the_run_ends_at_end_time() {
    for (length, like, ends, shortened) in [
        ("0.25", "", &[0.25, 0.5, 0.75, 1.0][..], false),
        ("0.1", "", &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0], false),
        ("0.3", "", &[0.3, 0.6, 0.9, 1.0], true),
        ("1.1", "", &[1.1], false),
        ("0.6", "", &[0.6, 1.2], false),
        ("0.7", "", &[0.7, 1.0], true),
        ("0.6, \"last_step\": \"shortened\"", "", &[0.6, 1.0], true),
        ("0.4, \"last_step\": \"whole\"", "", &[0.4, 0.8, 1.2], false),
        ("0.3", "kratos", &[0.3, 0.6, 0.9, 1.2], false),
        ("1.1", "kratos", &[1.1], false),
    ] {
        let scratch = case("structural/bar_plane_stress");
        change(scratch.path(), "\"time_step\": 1.0", &format!("\"time_step\": {length}"));
        let mut words = vec!["run", "ProjectParameters.json", "--report", "report.json"];
        words.extend(if like.is_empty() { vec![] } else { vec!["--like", like] });
        let output = zelus(scratch.path(), &words);
        assert!(output.status.success(), "{}", said(&output));
        let report = read_json(&scratch.path().join("report.json")).expect("a report");
        let times =
            report["steps"].as_array().expect("steps").iter().map(|step| step["time"].as_f64().expect("a time"));
        let times: Vec<f64> = times.collect();
        assert!(times.len() == ends.len(), "{length} {like}: {times:?}");
        assert!(times.iter().zip(ends).all(|(time, end)| (time - end).abs() < 1e-15), "{length} {like}: {times:?}");
        let number = length.split(',').next().expect("a number");
        let line = format!("the last step is shortened from {number} to");
        assert_eq!(said(&output).contains(&line), shortened, "{}", said(&output));
    }
}
