//! Runs every example and asserts the numbers of its `expected.json`.

use crate::support::{Results, read_nodes, root, said, scratch_copy, zelus};
use serde::Deserialize;
use std::path::Path;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Expected {
    deck: String,
    mesh: String,
    numbers: Vec<Number>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Number {
    name: String,
    kind: String,
    value: f64,
    relative_tolerance: f64,
    reason: String,
    measure: Measure,
}

/// How a number is read from nodal results.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Measure {
    /// The largest value of this quantity.
    largest: Option<String>,
    /// The x midway between the last node where this quantity is positive and the next one.
    edge: Option<String>,
    /// Multiplies the quantity first.
    factor: f64,
    results: String,
    time: Option<f64>,
    /// Only nodes with this initial y count.
    y: Option<f64>,
}

impl Measure {
    fn read(&self, folder: &Path, mesh: &str) -> Result<f64, String> {
        let results = Results::read(&folder.join(&self.results))?;
        let step = results.step(self.time)?;
        let quantity = self.largest.as_ref().or(self.edge.as_ref()).ok_or("a measure needs `largest` or `edge`")?;
        let nodes = read_nodes(&folder.join(mesh));
        let values = results.nodal(quantity, step);
        // reference nodes of couplings are not in the file
        let place = |id: &u64| nodes.get(id).copied().unwrap_or([f64::NAN; 3]);
        let counts = |id: &u64| self.y.is_none_or(|y| (place(id)[1] - y).abs() < 1e-9);
        let mut along: Vec<(f64, f64)> =
            values.iter().filter(|(id, _)| counts(id)).map(|(id, v)| (place(id)[0], v * self.factor)).collect();
        along.sort_by(|a, b| a.0.total_cmp(&b.0));
        let largest = along.iter().map(|(_, v)| *v).fold(f64::NEG_INFINITY, f64::max);
        if self.largest.is_some() {
            return Ok(largest);
        }
        let last = along.iter().rposition(|(_, v)| *v > 1e-9 * largest).ok_or("the quantity is zero")?;
        let next = along.get(last + 1).ok_or("the quantity is nowhere zero")?;
        Ok(0.5 * (along[last].0 + next.0))
    }
}

fn run(folder: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(folder.join("expected.json")).expect("expected.json");
    let expected: Expected = match serde_json::from_str(&text) {
        Ok(expected) => expected,
        Err(error) => return vec![format!("expected.json: {error}")],
    };
    let scratch = scratch_copy(folder);
    let output = zelus(scratch.path(), &["run", &expected.deck]);
    if !output.status.success() {
        return vec![format!("exit code {:?}\n{}", output.status.code(), said(&output))];
    }
    let mut problems = Vec::new();
    for number in &expected.numbers {
        match number.measure.read(scratch.path(), &expected.mesh) {
            Err(missing) => problems.push(format!("{}: {missing}", number.name)),
            Ok(found) if !found.is_finite() || (found / number.value - 1.0).abs() > number.relative_tolerance => {
                problems.push(format!(
                    "{}: {found}, {} {} ± {:.1} % ({})",
                    number.name,
                    number.kind,
                    number.value,
                    100.0 * number.relative_tolerance,
                    number.reason
                ))
            }
            Ok(_) => {}
        }
    }
    problems
}

#[test]
fn every_example_gives_its_numbers() {
    let mut count = 0;
    let mut failed = Vec::new();
    for entry in std::fs::read_dir(root().join("examples")).expect("examples").map(|e| e.expect("an entry").path()) {
        if entry.join("expected.json").is_file() {
            count += 1;
            failed.extend(run(&entry).into_iter().map(|problem| format!("{}: {problem}", entry.display())));
        }
    }
    assert!(count > 0, "no example was found");
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
