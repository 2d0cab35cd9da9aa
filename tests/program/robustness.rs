//! Every failure ends with an error message: whatever is nested, however little it is given, and wherever numbers run over.

use crate::support;
use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, Output};

use crate::support::{change, root, said, scratch_copy, zelus};

const DECK: &str = "ProjectParameters.json";

fn good_deck() -> tempfile::TempDir {
    scratch_copy(&root().join("tests/cases/contact_2d/matching"))
}

/// Ends with this code and these words, and neither panics nor dies of a signal.
fn ends(output: &Output, code: i32, words: &[&str]) {
    let text = said(output);
    assert_eq!(output.status.code(), Some(code), "{text}");
    words.iter().for_each(|word| assert!(text.contains(word), "{word:?} is not said:\n{text}"));
}

#[test]
fn five_thousand_nested_sub_model_parts_are_an_error_with_its_line() {
    let folder = good_deck();
    let mesh = folder.path().join("mesh.mdpa");
    let mut text = std::fs::read_to_string(&mesh).expect("the mesh");
    let line = text.lines().count() + 102;
    (0..5000).for_each(|at| writeln!(text, "Begin SubModelPart P{at}").expect("text"));
    text.push_str(&"End SubModelPart\n".repeat(5000));
    std::fs::write(&mesh, text).expect("the mesh");
    let output = zelus(folder.path(), &["check", DECK]);
    ends(&output, 2, &["error[nested-too-deep]", &format!("mesh.mdpa:{line}"), "nested more than 100 deep"]);
}

#[test]
fn deep_json_is_an_error_with_its_place() {
    for file in [DECK, "StructuralMaterials.json"] {
        for depth in [400, 100_000] {
            let folder = good_deck();
            let text = std::fs::read_to_string(folder.path().join(file)).expect("a file of the deck");
            let at = text.rfind('}').expect("an object");
            let deep = format!("{}, \"deep\": {}{}}}", &text[..at], "[".repeat(depth), "]".repeat(depth));
            std::fs::write(folder.path().join(file), deep).expect("a file of the deck");
            let output = zelus(folder.path(), &["check", DECK]);
            match depth {
                400 => assert_eq!(output.status.code(), Some(0), "{}", said(&output)),
                _ => ends(&output, 2, &["error[invalid-json]", file, "nesting depth"]),
            }
        }
    }
}

#[test]
fn deep_expressions_are_an_error_with_their_place() {
    let deep = |open: &str, close: &str| format!("\"{}t{}\"", open.repeat(50_000), close.repeat(50_000));
    for (expression, words) in [
        (deep("(", ")"), "nested more than 100 deep"),
        (deep("sin ", ""), "nested more than 100 deep"),
        (deep("t*(1+", ")"), "values are pending here"),
        (deep("pow(1, ", ")"), "values are pending here"),
    ] {
        let folder = good_deck();
        change(folder.path(), DECK, "\"modulus\": 1000000.0", &format!("\"modulus\": {expression}"));
        ends(&zelus(folder.path(), &["check", DECK]), 2, &["error[invalid-expression]", DECK, words]);
    }
}

/// `ulimit -v` in kilobytes for one run.
fn limited(folder: &Path, kilobytes: usize, threads: &str) -> Output {
    let line = format!("ulimit -v {kilobytes}; exec \"$0\" run {DECK} --threads {threads}");
    let mut command = Command::new("bash");
    command.args(["-c", &line, env!("CARGO_BIN_EXE_zelus")]).current_dir(folder).env("NO_COLOR", "1");
    command.output().expect("bash starts")
}

#[test]
#[cfg(target_os = "linux")]
fn a_limit_of_addresses_costs_threads_or_ends_in_words() {
    let folder = scratch_copy(&root().join("examples/hertz_line_contact"));
    let own = zelus_linear_algebra::address_space::of_a_thread() as usize >> 10;
    // The program with its libraries takes some of it: those of MPI and PETSc, where they are linked, more than all the rest.
    let starts = |limit: &usize| {
        let command = format!("ulimit -v {limit} && exec {} --version", env!("CARGO_BIN_EXE_zelus"));
        Command::new("sh").args(["-c", &command]).output().expect("a shell").status.success()
    };
    let base = (20_000..).step_by(10_000).find(starts).expect("some limit");
    ends(
        &limited(folder.path(), base + 100_000 + 2 * own, "64"),
        0,
        &["warning[address-space]", "threads run in place of 64"],
    );
    ends(&limited(folder.path(), base + own / 2, "2"), 4, &["error[system]", "ulimit -v"]);
    let results = |folder: &Path| support::contents(folder).into_iter().filter(|(name, _)| name.ends_with(".vtu"));
    let few: Vec<_> = results(folder.path()).collect();
    ends(&zelus(folder.path(), &["run", DECK, "--threads", "4"]), 0, &["4 threads"]);
    assert!(results(folder.path()).eq(few), "other bits with another number of threads");
}

#[test]
fn what_runs_over_is_named_by_node_unknown_and_giver() {
    let folder = good_deck();
    change(folder.path(), "mesh.mdpa", "SmallDisplacementElement2D4N", "TotalLagrangianElement2D4N");
    change(folder.path(), DECK, "\"value\": [null, 0.0, null]", "\"value\": [null, -1.0e200, null]");
    let giver = "the first to give such forces is TotalLagrangianElement2D4N";
    ends(
        &zelus(folder.path(), &["run", DECK]),
        3,
        &["error[not-converged]", "the residual of DISPLACEMENT_", "of node", giver],
    );
    let folder = good_deck();
    change(folder.path(), DECK, "\"modulus\": 1000000.0", "\"modulus\": 1.0e200");
    change(
        folder.path(),
        "StructuralMaterials.json",
        "\"YOUNG_MODULUS\": ",
        "\"YOUNG_MODULUS\": 1e-200, \"DENSITY\": ",
    );
    ends(&zelus(folder.path(), &["run", DECK]), 4, &["error[system]", "largest residual", "at DISPLACEMENT_Y of node"]);
}

#[test]
fn files_of_partition_in_no_folder_are_refused_before_the_mesh_is_read() {
    let folder = good_deck();
    std::fs::remove_file(folder.path().join("mesh.mdpa")).expect("the mesh");
    for option in ["--json", "--vtu"] {
        let output = zelus(folder.path(), &["partition", DECK, "-n", "2", option, "nowhere/cut"]);
        ends(&output, 4, &["there is no folder nowhere"]);
        assert!(!folder.path().join("nowhere").exists());
        let output = zelus(folder.path(), &["partition", DECK, "-n", "2", option, DECK]);
        ends(&output, 2, &["error[output-file]"]);
    }
}
