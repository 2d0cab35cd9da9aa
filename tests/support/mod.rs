//! Helpers of the system tests: scratch copies of decks, runs of the program, and reading of its results.
#![allow(dead_code, reason = "each test binary uses its part")]

use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The folder of the repository.
pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// A scratch copy of a folder, removed when dropped.
pub fn scratch_copy(folder: &Path) -> tempfile::TempDir {
    let scratch = tempfile::tempdir().expect("a scratch folder");
    copy_into(folder, scratch.path());
    scratch
}

/// Replaces a text in a file of a folder.
pub fn change(folder: &Path, file: &str, find: &str, with: &str) {
    let path = folder.join(file);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    assert!(text.contains(find), "{file} does not have {find:?}");
    std::fs::write(path, text.replace(find, with)).expect("the changed file");
}

fn copy_into(from: &Path, to: &Path) {
    for entry in std::fs::read_dir(from).unwrap_or_else(|e| panic!("{}: {e}", from.display())) {
        let entry = entry.expect("a folder entry");
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            std::fs::create_dir(&target).expect("a folder");
            copy_into(&entry.path(), &target);
        } else {
            std::fs::copy(entry.path(), &target).expect("a copy");
        }
    }
}

/// The cases of this repository: every folder below `tests/cases` with a `case.json`, ascending.
pub fn cases() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut pending = vec![root().join("tests/cases")];
    while let Some(folder) = pending.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder").map(|e| e.expect("an entry").path()) {
            if entry.is_dir() {
                pending.push(entry);
            } else if entry.file_name().is_some_and(|name| name == "case.json") {
                found.push(folder.clone());
            }
        }
    }
    found.sort();
    found
}

/// Every file under a folder with its content, by path relative to it.
pub fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut pending = vec![folder.to_owned()];
    while let Some(next) = pending.pop() {
        for entry in std::fs::read_dir(&next).expect("a folder") {
            let path = entry.expect("a folder entry").path();
            if path.is_dir() {
                pending.push(path);
            } else {
                let name = path.strip_prefix(folder).expect("below the folder").to_owned();
                found.insert(name, std::fs::read(&path).expect("a file"));
            }
        }
    }
    found
}

/// Runs `zelus` with arguments in a working folder.
pub fn zelus(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_zelus"))
        .args(arguments)
        .current_dir(folder)
        .env("NO_COLOR", "1")
        .output()
        .expect("the program starts")
}

/// Runs the deck of a folder, with the report run.json.
pub fn run_with_report(folder: &Path, deck: &str) {
    let output = zelus(folder, &["run", deck, "--report", "run.json", "-q"]);
    assert!(output.status.success(), "{}", said(&output));
}

/// Both streams of a finished run, for messages of failed tests.
pub fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

/// A JSON file.
pub fn read_json(path: &Path) -> Result<Value, String> {
    let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))
}

/// Node ids and initial coordinates of an mdpa file with one node a line.
pub fn read_nodes(path: &Path) -> BTreeMap<u64, [f64; 3]> {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let lines = text.lines().map(str::trim).skip_while(|line| *line != "Begin Nodes").skip(1);
    let mut nodes = BTreeMap::new();
    for line in lines.take_while(|line| *line != "End Nodes").filter(|line| !line.is_empty()) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let at = |i: usize| words[i].parse::<f64>().expect("a coordinate");
        nodes.insert(words[0].parse().expect("a node id"), [at(1), at(2), at(3)]);
    }
    nodes
}

/// Results of a `json_output_process`.
pub struct Results {
    root: Value,
    times: Vec<f64>,
}

impl Results {
    /// Reads the file.
    pub fn read(path: &Path) -> Result<Self, String> {
        let root = read_json(path)?;
        let times: Vec<f64> = root["TIME"].as_array().ok_or("no TIME")?.iter().filter_map(Value::as_f64).collect();
        if times.is_empty() {
            return Err(format!("{}: no step was written", path.display()));
        }
        Ok(Self { root, times })
    }

    /// Number of steps written.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Times of the steps written.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The position of a time, of the last one for `None`.
    pub fn step(&self, time: Option<f64>) -> Result<usize, String> {
        let Some(time) = time else { return Ok(self.times.len() - 1) };
        let found = self.times.iter().position(|t| (t - time).abs() < 1e-9 * time.abs().max(1.0));
        found.ok_or_else(|| format!("no time {time} among {:?}", self.times))
    }

    /// Values of a scalar at the nodes at one step, by node id.
    pub fn nodal(&self, quantity: &str, step: usize) -> BTreeMap<u64, f64> {
        let entries = self.root.as_object().expect("an object");
        let value =
            |key: &str, v: &Value| Some((key.strip_prefix("NODE_")?.parse().ok()?, v[quantity][step].as_f64()?));
        entries.iter().filter_map(|(key, v)| value(key, v)).collect()
    }

    /// Vectors at the Gauss points at one step: (element, point, components).
    pub fn gauss(&self, quantity: &str, step: usize) -> Vec<(String, String, Vec<f64>)> {
        let entries = self.root.as_object().expect("an object");
        let mut found = Vec::new();
        for (key, v) in entries.iter().filter(|(key, _)| key.starts_with("ELEMENT_")) {
            for (point, series) in v[quantity].as_object().into_iter().flatten() {
                let value = &series[step];
                let one = std::slice::from_ref(value);
                let components = value.as_array().map_or(one, Vec::as_slice).iter().filter_map(Value::as_f64).collect();
                found.push((key.clone(), point.clone(), components));
            }
        }
        found
    }
}

/// Reproducible numbers in [0, 1).
pub fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}
