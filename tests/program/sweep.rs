//! `run --sweep`: each row of a table is a run in a folder of its own, and one table tells of all.

use crate::support;
use crate::support::{read_json, root, said, scratch_copy, zelus};
use std::path::Path;

const DECK: &str = "ProjectParameters.json";
const LOAD: &str = "processes.loads_process_list.0.Parameters.modulus";

/// Rows of the table of results, each by the head of its column.
fn results(path: &Path) -> Vec<std::collections::BTreeMap<String, String>> {
    let text = std::fs::read_to_string(path).expect("the table of results");
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let heads = lines.next().expect("heads");
    lines.map(|line| heads.iter().cloned().zip(line).collect()).collect()
}

fn sweep(folder: &Path, table: &str, arguments: &[&str]) -> (Option<i32>, String) {
    std::fs::write(folder.join("loads.csv"), table).expect("a table");
    let output = zelus(folder, &[&["run", DECK, "--sweep", "loads.csv"], arguments].concat());
    (output.status.code(), said(&output))
}

#[test]
fn rows_are_runs_of_their_own_and_a_row_that_fails_stops_no_other() {
    let scratch = scratch_copy(&root().join("examples/hertz_line_contact"));
    let folder = scratch.path();
    let table = format!("{LOAD},problem_data.end_time\n9.0*t,0.25\nnonsense*t,0.25\n18.0*t,0.25\n");
    let (code, told) = sweep(folder, &table, &["-j", "2"]);
    assert_eq!(code, Some(2), "{told}");
    assert!(told.contains("2 of 3 rows done, 1 failed, 0 not begun"), "{told}");
    let rows = results(&folder.join("loads/results.csv"));
    let column = |name: &str| rows.iter().map(|row| row[name].as_str()).collect::<Vec<_>>();
    assert_eq!((column("exit_code"), column("steps")), (vec!["0", "2", "0"], vec!["1", "0", "1"]), "{rows:?}");
    assert!(rows[1]["error"].contains("error[") && rows[1]["error"].contains("nonsense"), "{rows:?}");
    // Twice the load gives twice the force, and by Hertz √2 times the pressure; the mesh is as coarse as the example's.
    let number = |row: usize, name: &str| -> f64 {
        let (_, value) = rows[row].iter().find(|(head, _)| head.starts_with(name)).expect("a column");
        value.parse().expect("a number")
    };
    let ratio = |name: &str| number(2, name) / number(0, name);
    assert!((ratio("force y on ") - 2.0).abs() < 1e-3, "{rows:?}");
    assert!((ratio("largest CONTACT_PRESSURE") - 2_f64.sqrt()).abs() < 0.1, "{rows:?}");
    // Each is the run that `--set` makes.
    let set = [format!("{LOAD}=18.0*t"), "problem_data.end_time=0.25".to_owned()];
    let output = zelus(folder, &["run", DECK, "--set", &set[0], "--set", &set[1], "--report", "run.json"]);
    assert!(output.status.success(), "{}", said(&output));
    let alone = read_json(&folder.join("run.json")).expect("a report");
    let of_row = read_json(&folder.join("loads/row_3/report.json")).expect("a report");
    assert_eq!(alone["largest"], of_row["largest"]);
    assert_eq!(alone["steps"][0]["balance"], of_row["steps"][0]["balance"]);
    let file = "contact_pressure.json";
    let read = |path: &str| std::fs::read(folder.join(path)).expect("results");
    assert_eq!(read(file), read(&format!("loads/row_3/{file}")));
    assert_ne!(read(file), read(&format!("loads/row_1/{file}")));
}

#[test]
fn rows_that_are_done_are_not_made_again_unless_something_changed() {
    let scratch = scratch_copy(&root().join("examples/hertz_line_contact"));
    let folder = scratch.path();
    let table = |second: &str| format!("{LOAD},problem_data.end_time\n9.0*t,0.25\n{second},0.25\n");
    let made = |told: &str| told.matches(" converged in ").count();
    let (code, told) = sweep(folder, &table("1.0*t*nonsense"), &[]);
    assert_eq!((code, made(&told)), (Some(2), 1), "{told}");
    let (code, told) = sweep(folder, &table("18.0*t"), &["--resume"]);
    assert_eq!((code, made(&told)), (Some(0), 1), "{told}");
    assert!(told.contains("row 1 of 2: done before"), "{told}");
    let (code, told) = sweep(folder, &table("18.0*t"), &["--resume"]);
    assert_eq!((code, made(&told)), (Some(0), 0), "{told}");
    support::change(folder, "StructuralMaterials.json", "POISSON_RATIO", "POISSON_RATIO");
    let (code, told) = sweep(folder, &table("18.0*t"), &["--resume"]);
    assert_eq!((code, made(&told)), (Some(0), 2), "{told}");
}

#[test]
fn tables_that_do_not_fit_are_refused_before_anything_runs() {
    let scratch = scratch_copy(&root().join("examples/hertz_line_contact"));
    for (table, fact) in [
        ("problem_data.end_time\n", "has no row of values"),
        ("problem_data.end_time\n0.25,3\n", "loads.csv:2:1: a row of 2 cells below 1 heads"),
        ("problem_data.end_time,problem_data.end_time\n0.25,3\n", "\"problem_data.end_time\" stands twice"),
        (",problem_data.end_time\n0.25,3\n", "the head \"\" is no key"),
    ] {
        let (code, told) = sweep(scratch.path(), table, &[]);
        assert_eq!(code, Some(2), "{told}");
        assert!(told.contains(fact) && told.contains("nothing was run"), "{told}");
        assert!(!scratch.path().join("loads").exists());
    }
    let (code, told) = sweep(scratch.path(), "problem_data.end_time\n0.25\n", &["--report", "run.json"]);
    assert_eq!(code, Some(2), "{told}");
    std::fs::create_dir(scratch.path().join("loads")).expect("a folder");
    std::fs::write(scratch.path().join("loads/results.csv"), "my own table\n").expect("a file");
    let (code, told) = sweep(scratch.path(), "problem_data.end_time\n0.25\n", &[]);
    assert!(code == Some(2) && told.contains("results.csv is nothing that an earlier run has written"), "{told}");
}

#[test]
fn results_are_written_below_the_folder_that_is_named() {
    let scratch = scratch_copy(&root().join("examples/hertz_line_contact"));
    let before = support::contents(scratch.path());
    let elsewhere = tempfile::tempdir().expect("a folder");
    let to = elsewhere.path().join("new/folder");
    let words = ["run", DECK, "--set", "problem_data.end_time=0.25", "--output", &to.to_string_lossy()];
    let output = zelus(scratch.path(), &words);
    assert!(output.status.success(), "{}", said(&output));
    assert_eq!(support::contents(scratch.path()), before, "files were written beside the deck");
    assert!(to.join("contact_pressure.json").is_file());
}
