//! Runs of decks by one rank and by many, and their comparison.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};
use std::time::Duration;

use serde_json::Value;

use crate::support::{contents, read_json, root, said, scratch_copy, zelus};

pub const RANKS: [usize; 4] = [1, 2, 3, 8];

pub const DECK: &str = "ProjectParameters.json";

/// Within this a failed run ends on all ranks.
pub const PROMPT: Duration = Duration::from_secs(30);

/// `mpirun` with the options to start more processes than there are cores.
pub fn mpirun(folder: &Path) -> Command {
    let version = Command::new("mpirun").arg("--version").output().expect("mpirun, which the feature `mpi` needs");
    let mut command = Command::new("mpirun");
    command.current_dir(folder).env("NO_COLOR", "1");
    if said(&version).contains("Open MPI") {
        command.env("OMPI_ALLOW_RUN_AS_ROOT", "1").env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1").arg("--oversubscribe");
        // Tests run beside each other: ranks that wait leave the cores to others.
        command.env("OMPI_MCA_mpi_yield_when_idle", "1").args(["--bind-to", "none"]);
    }
    command
}

pub fn distributed(folder: &Path, ranks: usize, arguments: &[&str]) -> Output {
    let mut command = mpirun(folder);
    command.args(["-n", &ranks.to_string(), env!("CARGO_BIN_EXE_zelus")]).args(arguments);
    command.output().expect("mpirun starts")
}

/// All numbers below `value`, by path.
pub fn numbers(value: &Value, path: &str, out: &mut BTreeMap<String, f64>) {
    match value {
        Value::Object(members) => members.iter().for_each(|(key, v)| numbers(v, &format!("{path}/{key}"), out)),
        Value::Array(items) => items.iter().enumerate().for_each(|(at, v)| numbers(v, &format!("{path}/{at}"), out)),
        _ => _ = value.as_f64().map(|number| out.insert(path.to_owned(), number)),
    }
}

/// The quantity a path belongs to, vectors as a whole.
pub fn quantity(path: &str) -> &str {
    let name = path.split('/').nth(2).unwrap_or(path);
    name.strip_suffix("_X").or(name.strip_suffix("_Y")).or(name.strip_suffix("_Z")).unwrap_or(name)
}

/// Numbers of every JSON file the run has written, and the iterations of its steps.
pub fn outcome(folder: &Path, before: &[std::path::PathBuf]) -> (BTreeMap<String, f64>, Vec<usize>) {
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

/// Bound of the weighted gaps of closed contact: the round-off of positions in blocks of unit size, which differs between machines.
const CLOSED_GAP: f64 = 1e-15;

/// Compares `found` with the expected values, within `tolerance` of the largest value of each quantity; gaps that are all closed,
/// within [`CLOSED_GAP`].
pub fn assert_near(found: &BTreeMap<String, f64>, expected: &BTreeMap<String, f64>, tolerance: f64, what: &str) {
    let mut largest: BTreeMap<&str, f64> = BTreeMap::new();
    for (path, value) in expected {
        let size = largest.entry(quantity(path)).or_insert(0.0);
        *size = size.max(value.abs());
    }
    assert!(found.keys().eq(expected.keys()), "{what} writes other results");
    for (path, value) in expected {
        let difference = (found[path] - value).abs();
        let (name, size) = (quantity(path), largest[quantity(path)]);
        let is_closed = name == "WEIGHTED_GAP" && size <= CLOSED_GAP;
        let allowed = if is_closed { CLOSED_GAP } else { tolerance * size };
        assert!(difference <= allowed, "{what}: {path} is {}, not {value}", found[path]);
    }
}

/// Runs a case serially and on every number of ranks; results may differ by `tolerance` of their quantity's largest value.
pub fn equals_serial(case: &str, changes: &[(&str, &str)], tolerance: f64, same_iterations: bool) {
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
    for ranks in RANKS {
        let folder = scratch_copy(original.path());
        let output = distributed(folder.path(), ranks, &arguments);
        assert!(output.status.success(), "{case} on {ranks} ranks: {}", said(&output));
        let (found, of_ranks) = outcome(folder.path(), &before);
        assert!(
            !same_iterations || of_ranks == iterations,
            "{case} on {ranks} ranks: {of_ranks:?}, not {iterations:?}"
        );
        assert_near(&found, &expected, tolerance, &format!("{case} on {ranks} ranks"));
        let whole = said(&output).contains("slave facets on 1 of them");
        assert!(!whole, "{case} on {ranks} ranks: the interface is not cut");
    }
}

/// A tolerance for results with a closed form, with which `tests/cases.rs` compares the serial run.
pub const EXACT: f64 = 1e-10;

/// A tolerance where round-off of the slip grows over steps of one iteration each, as `tests/contact/renumbering.rs` says.
pub const GROWN: f64 = 1e-7;

/// A tolerance for results without one.
pub const EQUAL: f64 = 1e-9;

pub fn case_folder(name: &str) -> std::path::PathBuf {
    root().join("tests/cases").join(name)
}

pub fn case(name: &str) -> tempfile::TempDir {
    scratch_copy(&case_folder(name))
}

/// The run fails with this exit code and says the text once.
pub fn fails(output: &Output, code: i32, text: &str) {
    let said = said(output);
    assert_eq!(output.status.code(), Some(code), "{said}");
    assert_eq!(said.matches(text).count(), 1, "{said}");
}
