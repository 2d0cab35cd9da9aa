//! Runs every deck of `examples/spring_and_wall` and asserts each iterate of each table.

use crate::support;
use crate::support::{root, said, scratch_copy, zelus};
use serde::Deserialize;
use std::path::Path;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Expected {
    deck: String,
    source: String,
    exit_code: i32,
    /// Lines that the program must print.
    says: Vec<String>,
    columns: Vec<String>,
    /// Round-off of a value or norm in double precision.
    round_off: f64,
    /// Numbers as the specification prints them.
    printed: Vec<Printed>,
    iterates: Vec<Iterate>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Printed {
    iterate: usize,
    what: String,
    value: f64,
    relative_tolerance: f64,
}

#[derive(Deserialize)]
struct Iterate {
    values: Vec<f64>,
    residual_norm: f64,
}

#[derive(Deserialize)]
struct Written {
    columns: Vec<String>,
    iterates: Vec<Iterate>,
}

impl Written {
    /// Reads the file that the deck's `iterate_output_process` names.
    fn of(deck: &Path) -> Result<Self, String> {
        let output = &support::read_json(deck)?["output_processes"]["iterates"][0]["Parameters"]["output_file_name"];
        let file = deck.with_file_name(output.as_str().ok_or("the deck writes no iterates")?);
        let text = std::fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))?;
        serde_json::from_str(&text).map_err(|e| format!("{}: {e}", file.display()))
    }

    fn get(&self, iterate: usize, what: &str) -> Option<f64> {
        let row = self.iterates.get(iterate)?;
        match self.columns.iter().position(|name| name == what) {
            Some(at) => row.values.get(at).copied(),
            None => (what == "residual_norm").then_some(row.residual_norm),
        }
    }
}

fn problems_of(expected: &Expected, folder: &Path) -> Vec<String> {
    let output = zelus(folder, &["run", &expected.deck]);
    let spoken = said(&output);
    if output.status.code() != Some(expected.exit_code) {
        return vec![format!("exit code {:?}, expected {}\n{spoken}", output.status.code(), expected.exit_code)];
    }
    let unsaid = expected.says.iter().filter(|words| !spoken.contains(*words));
    let mut problems: Vec<String> = unsaid.map(|words| format!("does not say {words:?}, but\n{spoken}")).collect();
    let written = match Written::of(&folder.join(&expected.deck)) {
        Ok(written) => written,
        Err(problem) => return vec![problem],
    };
    if written.columns != expected.columns || written.iterates.len() != expected.iterates.len() {
        return vec![format!(
            "{} iterates of {:?}, expected {} of {:?}",
            written.iterates.len(),
            written.columns,
            expected.iterates.len(),
            expected.columns
        )];
    }
    for (at, (found, wanted)) in written.iterates.iter().zip(&expected.iterates).enumerate() {
        let pairs = found.values.iter().zip(&wanted.values).chain([(&found.residual_norm, &wanted.residual_norm)]);
        for (found, wanted) in pairs {
            // A comparison that is false for a value that is not a number.
            let close = (found - wanted).abs() <= 1e-9 * wanted.abs() + expected.round_off;
            if !close {
                problems.push(format!("iterate {at}: {found:e}, expected {wanted:e}"));
            }
        }
    }
    for printed in &expected.printed {
        let found = written.get(printed.iterate, &printed.what).unwrap_or(f64::NAN);
        let close = (found / printed.value - 1.0).abs() <= printed.relative_tolerance;
        if !close {
            problems
                .push(format!("iterate {}: {} {found:e}, printed {:e}", printed.iterate, printed.what, printed.value));
        }
    }
    problems
}

/// Eq. D.25: condition numbers of the systems of the augmented Lagrangian, before the wall acts and after.
#[test]
fn condition_numbers_are_those_of_equation_d25() {
    let scratch = scratch_copy(&root().join("examples/spring_and_wall/moved_wall"));
    let deck = scratch.path().join("equation_d25.json");
    let text = std::fs::read_to_string(&deck).expect("the deck");
    for penalty in [0.5, 5.0, 100.0, 1e4] {
        std::fs::write(&deck, text.replace("\"penalty\": 5.0", &format!("\"penalty\": {penalty:e}")))
            .expect("the deck");
        let output = zelus(scratch.path(), &["run", "equation_d25.json", "--report", "report.json"]);
        assert!(output.status.success(), "{}", said(&output));
        let iterates = Written::of(&deck).expect("iterates").iterates;
        let report = support::read_json(&scratch.path().join("report.json")).expect("a report");
        let systems = report["steps"][0]["iterations"].as_array().expect("iterations");
        let mut acted = 0;
        for (system, iterate) in systems.iter().zip(&iterates) {
            let found = system["condition_number"].as_f64().expect("a condition number");
            let (u, multiplier) = (iterate.values[0], iterate.values[1]);
            let stiffness = 3.0 * (u + 1.0).powi(2);
            let expected = if multiplier + penalty * (u + 0.9) > 0.0 {
                (stiffness * penalty).max(1.0 / (stiffness * penalty))
            } else {
                acted += 1;
                let sum = stiffness + penalty;
                0.5 * sum * ((sum * sum + 4.0).sqrt() + sum) + 1.0
            };
            assert!((found / expected - 1.0).abs() < 1e-3, "ε = {penalty}, u = {u}: {found:e}, expected {expected:e}");
        }
        assert!(acted > 0 && acted < systems.len(), "{acted} of {} systems with the wall", systems.len());
    }
}

#[test]
fn every_table_is_reproduced_iterate_by_iterate() {
    let scratch = scratch_copy(&root().join("examples/spring_and_wall"));
    let mut problems = Vec::new();
    let mut sources = Vec::new();
    for entry in std::fs::read_dir(scratch.path()).expect("the scratch folder").map(|e| e.expect("an entry").path()) {
        let Ok(text) = std::fs::read_to_string(entry.join("expected.json")) else { continue };
        let decks: Vec<Expected> =
            serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}/expected.json: {e}", entry.display()));
        for expected in decks {
            let found = problems_of(&expected, &entry);
            problems.extend(found.into_iter().map(|p| format!("{} ({}): {p}", expected.deck, expected.source)));
            sources.push(expected.source);
        }
    }
    for table in 2..=15 {
        assert!(sources.contains(&format!("Table D.{table}")), "no deck runs Table D.{table}");
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn a_stalling_method_is_never_accepted() {
    let scratch = scratch_copy(&root().join("examples/spring_and_wall/moved_wall"));
    let deck = std::fs::read_to_string(scratch.path().join("table_d9.json")).expect("the deck");
    for iterations in ["20", "200"] {
        let longer = deck.replace("\"max_iteration\": 10", &format!("\"max_iteration\": {iterations}"));
        std::fs::write(scratch.path().join("longer.json"), longer).expect("a deck");
        let output = zelus(scratch.path(), &["run", "longer.json"]);
        assert_eq!(output.status.code(), Some(3), "{}", said(&output));
        assert!(said(&output).contains(&format!("not converged in {iterations} iterations")), "{}", said(&output));
    }
}

#[test]
fn walls_without_a_method_are_refused() {
    let scratch = scratch_copy(&root().join("examples/spring_and_wall/linear_spring"));
    let mut deck = support::read_json(&scratch.path().join("table_d2.json")).expect("the deck");
    deck["processes"] = serde_json::json!({});
    std::fs::write(scratch.path().join("free.json"), deck.to_string()).expect("a deck");
    let output = zelus(scratch.path(), &["run", "free.json"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("no process says how WallCondition2N is imposed"), "{}", said(&output));
}
