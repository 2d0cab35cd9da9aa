//! Runs every deck of `tests/cases` as a user would and compares with the reference in its `case.json`.
//!
//! `ZELUS_CASE=text` in the environment runs only the cases whose folder contains the text.

mod support;

use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;
use support::{Results, cases, read_nodes, root, said, scratch_copy, zelus};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Case {
    requirement: String,
    reference: Reference,
    why: String,
    checks: Vec<Check>,
}

#[derive(Deserialize)]
#[serde(rename_all = "UPPERCASE")]
enum Reference {
    Analytic,
    External,
    Regression,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Check {
    quantity: String,
    results: String,
    time: Option<f64>,
    nodes: Option<Vec<u64>>,
    value: Option<Value>,
    affine: Option<[f64; 4]>,
    tolerance: f64,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Value {
    Scalar(f64),
    Vector(Vec<f64>),
}

impl Check {
    /// The largest difference found and where, or the missing item.
    fn worst(&self, folder: &Path, nodes: &BTreeMap<u64, [f64; 3]>) -> Result<(f64, String), String> {
        let results = Results::read(&folder.join(&self.results))?;
        let step = results.step(self.time)?;
        let mut differences = Vec::new();
        if let Some(Value::Vector(expected)) = &self.value {
            for (element, point, found) in results.gauss(&self.quantity, step) {
                if found.len() != expected.len() {
                    return Err(format!("{element} point {point}: {} has {} components", self.quantity, found.len()));
                }
                let largest = found.iter().zip(expected).map(|(a, b)| size((a - b).abs())).fold(0.0, f64::max);
                differences.push((largest, format!("{element} point {point}: {found:?}, expected {expected:?}")));
            }
        } else {
            let mut found = results.nodal(&self.quantity, step);
            if let Some(wanted) = &self.nodes {
                found.retain(|id, _| wanted.contains(id));
                if found.len() != wanted.len() {
                    return Err(format!("{} is there at {} of {} nodes", self.quantity, found.len(), wanted.len()));
                }
            }
            for (id, value) in found {
                let x = nodes.get(&id).ok_or_else(|| format!("node {id} is not in the mesh"))?;
                let expected = match (&self.value, self.affine) {
                    (Some(Value::Scalar(value)), None) => *value,
                    (None, Some([c, cx, cy, cz])) => c + cx * x[0] + cy * x[1] + cz * x[2],
                    _ => return Err("a check needs either `value` or `affine`".into()),
                };
                differences.push(((value - expected).abs(), format!("node {id}: {value:e}, expected {expected:e}")));
            }
        }
        let worst = differences.into_iter().max_by(|a, b| size(a.0).total_cmp(&size(b.0)));
        worst.ok_or_else(|| format!("{} has no {}", self.results, self.quantity))
    }
}

/// A difference that is not a number counts as infinite.
fn size(difference: f64) -> f64 {
    if difference.is_nan() { f64::INFINITY } else { difference }
}

/// Faults of a case, empty when it passes.
fn run(folder: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(folder.join("case.json")).expect("case.json");
    let case: Case = match serde_json::from_str(&text) {
        Ok(case) => case,
        Err(error) => return vec![format!("case.json: {error}")],
    };
    let scratch = scratch_copy(folder);
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json"]);
    if !output.status.success() {
        return vec![format!("exit code {:?}\n{}", output.status.code(), said(&output))];
    }
    let nodes = read_nodes(&scratch.path().join("mesh.mdpa"));
    let mut problems = Vec::new();
    if case.checks.is_empty() {
        problems.push("nothing is checked".into());
    }
    for check in &case.checks {
        let name = format!("{} at time {:?} in {}", check.quantity, check.time, check.results);
        match check.worst(scratch.path(), &nodes) {
            Err(missing) => problems.push(format!("{name}: {missing}")),
            Ok((difference, place)) if size(difference) > check.tolerance => {
                problems.push(format!("{name}: off by {difference:.3e}, allowed {:.3e}, at {place}", check.tolerance));
            }
            Ok(_) => {}
        }
    }
    if !problems.is_empty() {
        let kind = match case.reference {
            Reference::Analytic => "closed form",
            Reference::External => "another program",
            Reference::Regression => "an earlier answer",
        };
        problems.push(format!("required: {}\n    reference: {kind}. {}", case.requirement, case.why));
    }
    problems
}

#[test]
fn every_case_agrees_with_its_reference() {
    let base = root().join("tests/cases");
    let mut folders = cases();
    let wanted = std::env::var("ZELUS_CASE").unwrap_or_default();
    folders.retain(|folder| folder.to_string_lossy().contains(&wanted));
    let mut failed = Vec::new();
    for folder in &folders {
        let problems = run(folder);
        if !problems.is_empty() {
            let name = folder.strip_prefix(&base).expect("below the base").display();
            failed.push(format!("{name}\n  {}", problems.join("\n  ")));
        }
    }
    assert!(!folders.is_empty(), "no case was found");
    assert!(failed.is_empty(), "{} of {} cases fail\n\n{}", failed.len(), folders.len(), failed.join("\n\n"));
}
