//! `zelus diff`: equal and different results, with place and time.

use std::path::Path;

use crate::renumber::reversed;
use crate::support::{change, root, said, scratch_copy, zelus};

const DECK: &str = "ProjectParameters.json";
const MESH: &str = "hertz_line_contact.mdpa";

/// The roller on a block, run.
fn run(prepare: impl Fn(&Path)) -> tempfile::TempDir {
    let folder = scratch_copy(&root().join("examples/hertz_line_contact"));
    prepare(folder.path());
    let output = zelus(folder.path(), &["run", DECK, "--report", "run.json"]);
    assert!(output.status.success(), "{}", said(&output));
    folder
}

fn diff(arguments: &[&str]) -> (Option<i32>, String) {
    let output = zelus(&root(), &[&["diff"], arguments].concat());
    (output.status.code(), said(&output))
}

fn path(folder: &tempfile::TempDir, name: &str) -> String {
    folder.path().join(name).to_string_lossy().into_owned()
}

#[test]
fn equal_runs_are_equal_and_others_are_told_by_node_step_and_field() {
    let (one, same) = (run(|_| {}), run(|_| {}));
    let names = ["vtu_output", "run.json", "vtu_output/Structure.pvd", "vtu_output/Structure_4.vtu"];
    for name in names {
        let (code, text) = diff(&[&path(&one, name), &path(&same, name)]);
        assert_eq!(code, Some(0), "{name}: {text}");
        assert!(text.contains("equal: ") && text.contains("DISPLACEMENT: largest difference 0.000e0"), "{text}");
        assert!(!text.contains("equal: 0 numbers"), "{text}");
    }
    let stiffer = run(|folder| {
        change(folder, "StructuralMaterials.json", "\"POISSON_RATIO\"", "\"DENSITY\": 1.0, \"POISSON_RATIO\"")
    });
    assert_eq!(diff(&[&path(&one, "run.json"), &path(&stiffer, "run.json")]).0, Some(0));
    let other =
        run(|folder| change(folder, "StructuralMaterials.json", "\"POISSON_RATIO\": 0.3", "\"POISSON_RATIO\": 0.3003"));
    for name in names {
        let (code, text) = diff(&[&path(&one, name), &path(&other, name)]);
        assert_eq!(code, Some(1), "{name}: {text}");
        assert!(text.contains("DISPLACEMENT: largest difference") && text.contains(" at component"), "{text}");
        assert!(text.contains("step ") && text.contains("different: "), "{text}");
        assert_eq!(diff(&[&path(&one, name), &path(&other, name), "--tolerance", "0.2"]).0, Some(0), "{name}");
    }
    std::fs::remove_file(path(&other, "vtu_output/Structure.pvd")).expect("the list of steps");
    let (code, text) = diff(&[&path(&one, "vtu_output"), &path(&other, "vtu_output")]);
    assert!(code == Some(1) && text.contains("Structure.pvd is only in"), "{text}");
}

#[test]
fn points_that_are_numbered_otherwise_are_told_by_their_places() {
    let (one, other) = (
        run(|_| {}),
        run(|folder| {
            let text = std::fs::read_to_string(folder.join(MESH)).expect("the mesh");
            std::fs::write(folder.join(MESH), reversed(&text).1).expect("the mesh");
        }),
    );
    let (code, text) = diff(&[&path(&one, "vtu_output"), &path(&other, "vtu_output"), "--tolerance", "1e-8"]);
    assert!(code == Some(0) && text.contains("points are told by their places"), "{text}");
    assert_eq!(diff(&[&path(&one, "vtu_output"), &path(&other, "vtu_output"), "--tolerance", "1e-17"]).0, Some(1));
}

#[test]
fn histories_are_compared_by_id_and_steps_are_counted() {
    let deck = |end: &str| {
        let folder = scratch_copy(&root().join("tests/cases/contact_2d/matching"));
        change(folder.path(), DECK, "\"end_time\": 1.0", end);
        assert!(zelus(folder.path(), &["run", DECK]).status.success());
        folder
    };
    let (one, two, longer) = (deck("\"end_time\": 1.0"), deck("\"end_time\": 1.0"), deck("\"end_time\": 2.0"));
    let (code, text) = diff(&[&path(&one, ""), &path(&two, "")]);
    assert!(code == Some(0) && text.contains("upper.json DISPLACEMENT"), "{text}");
    let (code, text) = diff(&[&path(&one, "upper.json"), &path(&longer, "upper.json")]);
    assert!(code == Some(1) && text.contains("1 steps and 2"), "{text}");
}

#[test]
fn what_has_no_results_is_bad_input() {
    let folder = scratch_copy(&root().join("tests/cases/contact_2d/matching"));
    for (name, words) in
        [("", "there are no results"), (DECK, "holds no histories"), ("nothing", "there is no such file")]
    {
        let path = path(&folder, name);
        let (code, text) = diff(&[&path, &path]);
        assert!(code == Some(2) && text.contains("error[no-results]") && text.contains(words), "{name}: {text}");
    }
    std::fs::write(folder.path().join("a.vtu"), "no picture").expect("a file");
    let (code, text) = diff(&[&path(&folder, "a.vtu"), &path(&folder, "a.vtu")]);
    assert!(code == Some(2) && text.contains("error[unreadable-file]") && text.contains("no appended data"), "{text}");
}
