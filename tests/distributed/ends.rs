//! How runs end that fail: at once, on all ranks, and in words that are said once.

use std::path::Path;
use std::process::Output;
use std::time::Instant;

use crate::files::PICTURES;
use crate::runs::*;
use crate::support::{change, contents, said, zelus};

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn a_bad_deck_is_said_once() {
    let folder = case("contact_2d/nonmatching");
    change(folder.path(), DECK, "\"Static\"", "\"Statik\"");
    let output = distributed(folder.path(), 3, &["run", DECK]);
    fails(&output, 2, "error[");
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn a_step_that_does_not_converge_ends_all_ranks() {
    let folder = case("contact_2d/friction_slide");
    change(folder.path(), DECK, "\"max_iteration\": 30", "\"max_iteration\": 1, \"step_cutting\": false");
    let output = distributed(folder.path(), 3, &["run", DECK]);
    fails(&output, 3, "error[not-converged]");
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn a_file_that_cannot_be_written_is_said_once() {
    let folder = case("contact_2d/nonmatching");
    change(folder.path(), DECK, "\"output_file_name\": \"", "\"output_file_name\": \"mesh.mdpa/");
    let output = distributed(folder.path(), 3, &["run", DECK]);
    fails(&output, 2, "mesh.mdpa/lower.json: ");
}

/// Runs the deck on three ranks of which `rank` finds the disk full when it writes `file`.
fn full_disk(folder: &Path, rank: usize, file: &str) -> Output {
    let mut command = mpirun(folder);
    let program = env!("CARGO_BIN_EXE_zelus");
    let (path, name) = file.rsplit_once('/').map_or((".", file), |(path, name)| (path, name));
    // a rank writes first to the name with its process id, which exec keeps
    let full = format!("mkdir -p {path}; ln -s /dev/full {path}/.{name}.$$.part; exec {program} run {DECK}");
    for at in 0..3 {
        command.args([if at > 0 { ":" } else { "-n" }, if at > 0 { "-n" } else { "1" }]);
        command.args(if at > 0 { &["1"][..] } else { &[] });
        command.args(if at == rank { vec!["sh", "-c", &full] } else { vec![program, "run", DECK] });
    }
    let start = Instant::now();
    let output = command.output().expect("mpirun starts");
    assert!(start.elapsed() < PROMPT, "{}", said(&output));
    output
}

#[test]
#[cfg_attr(not(all(feature = "mpi", target_os = "linux")), ignore = "needs the feature `mpi` and /dev/full")]
fn a_full_disk_of_another_rank_ends_all_ranks() {
    let folder = case("contact_2d/nonmatching");
    change(folder.path(), DECK, "\"json_output_process_list\"", PICTURES);
    let output = full_disk(folder.path(), 1, "VTU_Output/Structure_1_1.vtu");
    fails(&output, 4, "Structure_1_1.vtu: cannot be written");
    assert!(!folder.path().join("VTU_Output/Structure_1.pvtu").exists(), "a list of what is not there");
}

#[test]
#[cfg_attr(not(all(feature = "mpi", target_os = "linux")), ignore = "needs the feature `mpi` and /dev/full")]
fn a_full_disk_ends_all_ranks() {
    let folder = case("contact_2d/nonmatching");
    let output = full_disk(folder.path(), 0, "lower.json");
    fails(&output, 4, "lower.json: cannot be written");
    let parts = contents(folder.path()).into_keys().filter(|name| name.extension().is_some_and(|e| e == "part"));
    assert_eq!(parts.count(), 0, "half-written files stay");
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn a_body_that_nothing_holds_is_said_once() {
    for engine in ["", "mumps_lu", "none"] {
        let folder = case("contact_2d/nonmatching");
        change(folder.path(), DECK, "[true, false, false]", "[false, false, false]");
        let settings = format!("\"Static\", \"linear_solver_settings\": {{\"petsc_engine\": \"{engine}\"}}");
        change(folder.path(), DECK, "\"Static\"", &settings);
        let output = distributed(folder.path(), 3, &["run", DECK]);
        fails(&output, 4, "error[system]");
        assert!(said(&output).contains("the system of equations is singular"), "{}", said(&output));
        assert!(said(&output).contains("DISPLACEMENT_X of node"), "{}", said(&output));
    }
}

/// Rank 0 runs the deck of one folder, rank 1 that of another.
fn one_each(first: &Path, second: &Path) -> Output {
    let mut command = mpirun(first);
    let program = env!("CARGO_BIN_EXE_zelus");
    let decks = [first, second].map(|folder| folder.join(DECK).to_string_lossy().into_owned());
    let report = ["--report", "report.json"];
    command.args(["-n", "1", program, "run", &decks[0]]).args(report);
    command.args([":", "-n", "1", program, "run", &decks[1]]).args(report);
    let start = Instant::now();
    let output = command.output().expect("mpirun starts");
    assert!(start.elapsed() < PROMPT, "{}", said(&output));
    output
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn a_rank_that_fails_alone_ends_all() {
    let (good, bad) = (case("contact_2d/nonmatching"), case("contact_2d/nonmatching"));
    std::fs::remove_file(bad.path().join(DECK)).expect("a deck");
    let output = one_each(good.path(), bad.path());
    fails(&output, 2, "error[unreadable-file]");
    let output = one_each(bad.path(), good.path());
    fails(&output, 2, "error[unreadable-file]");
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn only_rank_0_reads_meshes_and_materials() {
    let [alone, one, other] = [(); 3].map(|()| case("contact_2d/nonmatching"));
    let before: Vec<_> = contents(alone.path()).into_keys().collect();
    for file in ["mesh.mdpa", "StructuralMaterials.json"] {
        std::fs::remove_file(other.path().join(file)).expect("a file of the case");
    }
    let output = one_each(one.path(), other.path());
    assert!(output.status.success(), "{}", said(&output));
    zelus(alone.path(), &["run", DECK, "--report", "report.json"]);
    let [expected, found] = [&alone, &one].map(|folder| outcome(folder.path(), &before));
    assert!(!expected.0.is_empty() && expected.1 == found.1);
    assert_near(&found.0, &expected.0, 1e-9, "one of two ranks without a mesh");
    let output = one_each(other.path(), one.path());
    fails(&output, 2, "error[missing-file]");
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn ranks_with_different_settings_do_not_run() {
    for (file, find, with, says) in [
        (DECK, "\"end_time\": 1.0", "\"end_time\": 6.0", "the ranks have read different decks"),
        ("load.csv", "1.0, -2.0", "1.0, -2.5", "load.csv"),
    ] {
        let (one, other) = (case("contact_2d/nonmatching"), case("contact_2d/nonmatching"));
        for folder in [&one, &other] {
            std::fs::write(folder.path().join("load.csv"), "0.0, 0.0\n1.0, -2.0\n").expect("a table");
            let table = "\"modulus\": {\"name\": \"csv_table\", \"filename\": \"load.csv\"}";
            change(folder.path(), DECK, "\"modulus\": 1000000.0", table);
        }
        change(other.path(), file, find, with);
        let output = one_each(one.path(), other.path());
        fails(&output, 4, says);
    }
}

/// One rank alone owns the element.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn an_inverted_element_is_said_once() {
    let folder = case("contact_2d/nonmatching");
    change(folder.path(), "mesh.mdpa", "\n1 0 1 2 6 5\n", "\n1 0 1 5 6 2\n");
    let output = distributed(folder.path(), 3, &["run", DECK]);
    fails(&output, 2, "error[");
    assert!(said(&output).contains("SmallDisplacementElement2D4N 1 "), "{}", said(&output));
}

/// Elements that a load turns inside out on some of the ranks cut the step on all of them, until there is none to cut.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn an_element_that_fails_in_a_step_ends_all_ranks() {
    let folder = case("contact_2d/nonmatching");
    change(folder.path(), "mesh.mdpa", "SmallDisplacementElement2D4N", "TotalLagrangianElement2D4N");
    change(folder.path(), "StructuralMaterials.json", "LinearElasticPlaneStrain2DLaw", "HyperElasticPlaneStrain2DLaw");
    change(folder.path(), DECK, "\"modulus\": 1000000.0", "\"modulus\": 1e15");
    let output = distributed(folder.path(), 2, &["run", DECK]);
    fails(&output, 3, "error[not-converged]");
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn a_killed_rank_ends_all() {
    let folder = case("contact_2d/opening");
    change(folder.path(), DECK, "\"end_time\": ", "\"end_time\": 100000");
    let mut command = mpirun(folder.path());
    let program = env!("CARGO_BIN_EXE_zelus");
    let killed = format!("{program} run {DECK} & sleep 2; kill -9 $!; wait $!");
    command.args(["-n", "1", program, "run", DECK, ":", "-n", "1", "sh", "-c", &killed]);
    let start = Instant::now();
    let output = command.output().expect("mpirun starts");
    assert!(!output.status.success() && start.elapsed() < PROMPT, "{}", said(&output));
}
