//! Runs on several processes: the same answers in the same iterations as one process gives, and clean ends of failed runs.
//!
//! They need the feature `mpi` and mpirun; without them they say so and pass.

mod support;

use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, Instant};
use support::{change, contents, read_json, root, said, scratch_copy, zelus};

const RANKS: [usize; 5] = [1, 2, 3, 4, 8];
const DECK: &str = "ProjectParameters.json";
/// Within this a failed run ends on all ranks.
const PROMPT: Duration = Duration::from_secs(30);

/// `mpirun` with what it needs to start more processes than there are cores; `None`, with a line, when tests are skipped.
fn mpirun(folder: &Path) -> Option<Command> {
    if !cfg!(feature = "mpi") {
        println!("skipped: built without the feature `mpi`");
        return None;
    }
    let Ok(version) = Command::new("mpirun").arg("--version").output() else {
        println!("skipped: there is no mpirun");
        return None;
    };
    let mut command = Command::new("mpirun");
    command.current_dir(folder).env("NO_COLOR", "1");
    if said(&version).contains("Open MPI") {
        command.env("OMPI_ALLOW_RUN_AS_ROOT", "1").env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1").arg("--oversubscribe");
    }
    Some(command)
}

fn distributed(folder: &Path, ranks: usize, arguments: &[&str]) -> Option<Output> {
    let mut command = mpirun(folder)?;
    command.args(["-n", &ranks.to_string(), env!("CARGO_BIN_EXE_zelus")]).args(arguments);
    Some(command.output().expect("mpirun starts"))
}

/// All numbers below `value`, by path.
fn numbers(value: &Value, path: &str, out: &mut BTreeMap<String, f64>) {
    match value {
        Value::Object(members) => members.iter().for_each(|(key, v)| numbers(v, &format!("{path}/{key}"), out)),
        Value::Array(items) => items.iter().enumerate().for_each(|(at, v)| numbers(v, &format!("{path}/{at}"), out)),
        _ => _ = value.as_f64().map(|number| out.insert(path.to_owned(), number)),
    }
}

/// The quantity a path belongs to, vectors as a whole.
fn quantity(path: &str) -> &str {
    let name = path.split('/').nth(2).unwrap_or(path);
    name.strip_suffix("_X").or(name.strip_suffix("_Y")).or(name.strip_suffix("_Z")).unwrap_or(name)
}

/// Numbers of every JSON file the run has written, and the iterations of its steps.
fn outcome(folder: &Path, before: &[std::path::PathBuf]) -> (BTreeMap<String, f64>, Vec<usize>) {
    let mut found = BTreeMap::new();
    for name in contents(folder).into_keys().filter(|name| !before.contains(name)) {
        if name.extension().is_some_and(|e| e == "json") && name != Path::new("report.json") {
            let key = name.to_string_lossy().replace('/', "_");
            numbers(&read_json(&folder.join(&name)).expect("results"), &key, &mut found);
        }
    }
    let report = read_json(&folder.join("report.json")).expect("the report");
    let steps = report["steps"].as_array().expect("steps").iter();
    (found, steps.map(|step| step["iterations"].as_array().map_or(0, Vec::len)).collect())
}

/// Runs a case serially and on every number of ranks; results may differ by `tolerance` of their quantity's largest value.
fn equals_serial(case: &str, changes: &[(&str, &str)], tolerance: f64, same_iterations: bool) {
    let original = scratch_copy(&root().join("tests/cases").join(case));
    let path = original.path().join(DECK);
    let mut text = std::fs::read_to_string(&path).expect("the deck");
    for (find, with) in changes {
        assert!(text.contains(find), "{case} does not have {find:?}");
        text = text.replace(find, with);
    }
    std::fs::write(&path, text).expect("the deck");
    let before: Vec<_> = contents(original.path()).into_keys().collect();
    let arguments = ["run", DECK, "--report", "report.json"];
    let alone = scratch_copy(original.path());
    let output = zelus(alone.path(), &arguments);
    assert!(output.status.success(), "{case}: {}", said(&output));
    let (expected, iterations) = outcome(alone.path(), &before);
    assert!(!expected.is_empty(), "{case} writes no JSON results");
    let mut largest: BTreeMap<&str, f64> = BTreeMap::new();
    for (path, value) in &expected {
        let size = largest.entry(quantity(path)).or_insert(0.0);
        *size = size.max(value.abs());
    }
    for ranks in RANKS {
        let folder = scratch_copy(original.path());
        let Some(output) = distributed(folder.path(), ranks, &arguments) else { return };
        assert!(output.status.success(), "{case} on {ranks} ranks: {}", said(&output));
        let (found, of_ranks) = outcome(folder.path(), &before);
        assert!(
            !same_iterations || of_ranks == iterations,
            "{case} on {ranks} ranks: {of_ranks:?}, not {iterations:?}"
        );
        assert!(found.keys().eq(expected.keys()), "{case} on {ranks} ranks writes other results");
        for (path, value) in &expected {
            let difference = (found[path] - value).abs();
            let size = largest[quantity(path)];
            assert!(difference <= tolerance * size, "{case} on {ranks} ranks: {path} is {}, not {value}", found[path]);
        }
        let whole = said(&output).contains("slave facets on 1 of them");
        assert!(!whole, "{case} on {ranks} ranks: the interface is not cut");
    }
}

/// A tolerance for what has a closed form, which `tests/cases.rs` holds the serial run to.
const EXACT: f64 = 1e-10;
/// A tolerance for what has none.
const EQUAL: f64 = 1e-9;

#[test]
fn bodies_without_contact() {
    equals_serial("elements/load_patch_2D4N", &[], EXACT, true);
    equals_serial("elements/displacement_patch_3D8N", &[], EXACT, true);
}

#[test]
fn frictionless_contact_in_the_plane() {
    equals_serial("contact_2d/nonmatching", &[], EXACT, true);
    equals_serial("contact_2d/opening", &[], EXACT, true);
}

#[test]
fn frictionless_contact_in_space() {
    equals_serial("contact_3d/hexahedra_nonmatching", &[], EXACT, true);
    equals_serial("contact_3d/tetrahedra_on_hexahedra", &[], EXACT, true);
}

/// Slips of sticking nodes are round-off and left out; which nodes of the sliding case stick at first is a tie of round-off.
#[test]
fn frictional_contact() {
    equals_serial("contact_2d/friction_stick", &[("\"WEIGHTED_SLIP\"", "\"DISPLACEMENT\"")], EXACT, true);
    equals_serial("contact_3d/friction_stick", &[("\"WEIGHTED_SLIP\"", "\"DISPLACEMENT\"")], EXACT, true);
    equals_serial("contact_2d/friction_slide", &[], EXACT, false);
}

#[test]
fn penalty_contact() {
    let common =
        [("alm_contact_process", "penalty_contact_process"), ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", "WEIGHTED_GAP")];
    let frictionless = [&common[..], &[("ALMContactFrictionless", "PenaltyContactFrictionless")]].concat();
    let sliding = "\"contact_type\": \"Frictional\", \"friction_coefficients\": {\"0\": 0.3}";
    let frictional =
        [("ALMContactFrictionless", "PenaltyContactFrictional"), ("\"contact_type\": \"Frictionless\"", sliding)];
    equals_serial("contact_2d/nonmatching", &frictionless, EQUAL, true);
    equals_serial("contact_3d/hexahedra_nonmatching", &frictionless, EQUAL, true);
    equals_serial("contact_2d/nonmatching", &[&common[..], &frictional].concat(), EQUAL, true);
}

#[test]
fn tied_meshes() {
    equals_serial("mesh_tying/triangles_on_quadrilaterals", &[], EXACT, true);
    equals_serial("mesh_tying/tetrahedra_on_hexahedra", &[], EXACT, true);
}

/// Systems as small as these are solved by rank 0 unless the deck asks for PETSc.
#[test]
fn petsc_solves_for_all() {
    if !cfg!(feature = "petsc") {
        println!("skipped: built without the feature `petsc`");
        return;
    }
    let asks = "\"solver_type\": \"Static\", \"linear_solver_settings\": {\"petsc_engine\": \"automatic\"}";
    let asks = [("\"solver_type\": \"Static\"", asks)];
    equals_serial("contact_2d/nonmatching", &asks, EXACT, true);
    equals_serial("contact_2d/opening", &asks, EXACT, true);
    equals_serial("contact_3d/hexahedra_nonmatching", &asks, EXACT, true);
    equals_serial("mesh_tying/tetrahedra_on_hexahedra", &asks, EXACT, true);
    equals_serial("mpc/pressed_and_opened", &asks, EXACT, true);
}

#[test]
fn contact_by_constraints() {
    equals_serial("mpc/pressed_and_opened", &[], EXACT, true);
    equals_serial("mpc/pressed_and_opened_hexahedra", &[], EXACT, true);
    equals_serial("mpc/tying_matching_hexahedra", &[], EXACT, true);
}

fn case(name: &str) -> tempfile::TempDir {
    scratch_copy(&root().join("tests/cases").join(name))
}

/// The run fails with this exit code and says the text once.
fn fails(output: &Output, code: i32, text: &str) {
    let said = said(output);
    assert_eq!(output.status.code(), Some(code), "{said}");
    assert_eq!(said.matches(text).count(), 1, "{said}");
}

#[test]
fn a_bad_deck_is_said_once() {
    let folder = case("contact_2d/nonmatching");
    change(folder.path(), DECK, "\"Static\"", "\"Statik\"");
    let Some(output) = distributed(folder.path(), 3, &["run", DECK]) else { return };
    fails(&output, 2, "error[");
}

#[test]
fn a_step_that_does_not_converge_ends_all_ranks() {
    let folder = case("contact_2d/friction_slide");
    change(folder.path(), DECK, "\"max_iteration\": 30", "\"max_iteration\": 1, \"step_cutting\": false");
    let Some(output) = distributed(folder.path(), 3, &["run", DECK]) else { return };
    fails(&output, 3, "error[not-converged]");
}

#[test]
fn a_file_that_cannot_be_written_ends_all_ranks() {
    let folder = case("contact_2d/nonmatching");
    change(folder.path(), DECK, "\"output_file_name\": \"", "\"output_file_name\": \"mesh.mdpa/");
    let Some(output) = distributed(folder.path(), 3, &["run", DECK]) else { return };
    fails(&output, 4, "error[system]");
}

#[test]
fn a_full_disk_ends_all_ranks() {
    if !Path::new("/dev/full").exists() {
        return println!("skipped: there is no /dev/full to play a full disk");
    }
    let folder = case("contact_2d/nonmatching");
    let Some(mut command) = mpirun(folder.path()) else { return };
    let program = env!("CARGO_BIN_EXE_zelus");
    // what rank 0 writes first goes to the name with its process id, which exec keeps
    let full = format!("ln -s /dev/full .lower.json.$$.part; exec {program} run {DECK}");
    command.args(["-n", "1", "sh", "-c", &full, ":", "-n", "2", program, "run", DECK]);
    let start = Instant::now();
    let output = command.output().expect("mpirun starts");
    assert!(start.elapsed() < PROMPT, "{}", said(&output));
    fails(&output, 4, "lower.json: cannot be written");
    let parts = contents(folder.path()).into_keys().filter(|name| name.extension().is_some_and(|e| e == "part"));
    assert_eq!(parts.count(), 0, "half-written files stay");
}

#[test]
fn a_body_that_nothing_holds_is_said_once() {
    for engine in ["", "mumps_lu", "none"] {
        let folder = case("contact_2d/nonmatching");
        change(folder.path(), DECK, "[true, false, false]", "[false, false, false]");
        let settings = format!("\"Static\", \"linear_solver_settings\": {{\"petsc_engine\": \"{engine}\"}}");
        change(folder.path(), DECK, "\"Static\"", &settings);
        let Some(output) = distributed(folder.path(), 3, &["run", DECK]) else { return };
        fails(&output, 4, "error[system]");
        assert!(said(&output).contains("the system of equations is singular"), "{}", said(&output));
        assert!(said(&output).contains("DISPLACEMENT_X of node"), "{}", said(&output));
    }
}

/// Rank 0 runs the deck of one folder, rank 1 that of another.
fn one_each(first: &Path, second: &Path) -> Option<Output> {
    let mut command = mpirun(first)?;
    let program = env!("CARGO_BIN_EXE_zelus");
    let decks = [first, second].map(|folder| folder.join(DECK).to_string_lossy().into_owned());
    command.args(["-n", "1", program, "run", &decks[0], ":", "-n", "1", program, "run", &decks[1]]);
    let start = Instant::now();
    let output = command.output().expect("mpirun starts");
    assert!(start.elapsed() < PROMPT, "{}", said(&output));
    Some(output)
}

#[test]
fn a_rank_that_fails_alone_ends_all() {
    let (good, bad) = (case("contact_2d/nonmatching"), case("contact_2d/nonmatching"));
    std::fs::remove_file(bad.path().join("mesh.mdpa")).expect("a mesh");
    let Some(output) = one_each(good.path(), bad.path()) else { return };
    fails(&output, 2, "error[missing-file]");
    let Some(output) = one_each(bad.path(), good.path()) else { return };
    fails(&output, 2, "error[missing-file]");
}

#[test]
fn ranks_with_different_meshes_do_not_run() {
    let (one, other) = (case("contact_2d/nonmatching"), case("contact_2d/matching"));
    let Some(output) = one_each(one.path(), other.path()) else { return };
    fails(&output, 4, "the ranks have read different meshes");
}

#[test]
fn a_killed_rank_ends_all() {
    let folder = case("contact_2d/opening");
    change(folder.path(), DECK, "\"end_time\": ", "\"end_time\": 100000");
    let Some(mut command) = mpirun(folder.path()) else { return };
    let program = env!("CARGO_BIN_EXE_zelus");
    let killed = format!("{program} run {DECK} & sleep 2; kill -9 $!; wait $!");
    command.args(["-n", "1", program, "run", DECK, ":", "-n", "1", "sh", "-c", &killed]);
    let start = Instant::now();
    let output = command.output().expect("mpirun starts");
    assert!(!output.status.success() && start.elapsed() < PROMPT, "{}", said(&output));
}

/// A program without MPI that is started as one of several would run the whole deck in each of them.
#[test]
fn several_processes_need_the_feature() {
    if cfg!(feature = "mpi") {
        return;
    }
    let folder = case("contact_2d/nonmatching");
    let output = Command::new(env!("CARGO_BIN_EXE_zelus"))
        .args(["run", DECK])
        .current_dir(folder.path())
        .env("OMPI_COMM_WORLD_SIZE", "2")
        .output()
        .expect("the program starts");
    assert_eq!(output.status.code(), Some(4), "{}", said(&output));
    assert!(said(&output).contains("without the feature `mpi`"), "{}", said(&output));
}
