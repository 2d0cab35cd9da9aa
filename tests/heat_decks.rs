//! The decks of heat with known answers, which stand outside of the repository: `ZELUS_HEAT_DECKS` in the environment names their folder.

mod support;

use serde_json::Value;
use std::path::PathBuf;
use std::process::Command;
use support::{read_json, root, said};

/// Counted decks that do not pass, and why.
const OPEN: &[(&str, &str)] = &[
    ("conv_diff_tests/bar_explicit_QASGS", "steps too long to be stable, with --like kratos alone"),
    (
        "kratos_thermomech_tests/coupled_accessor",
        "gradients of quadrilaterals at their centre, with --like kratos alone",
    ),
    ("own_contact/transient_heating_contact_tri", "its contact is that of Kratos with --like kratos alone"),
];

fn folder() -> Option<PathBuf> {
    let named = std::env::var_os("ZELUS_HEAT_DECKS").map(PathBuf::from);
    let folder = named.unwrap_or_else(|| root().join("../shared/heat"));
    let there = folder.join("tools/heat_scoreboard.py").is_file();
    if !there {
        println!("skipped: {} has no decks of heat", folder.display());
    }
    there.then_some(folder)
}

#[test]
fn every_deck_has_its_known_answer() {
    let Some(folder) = folder() else { return };
    let scratch = tempfile::tempdir().expect("a scratch folder");
    let scores = scratch.path().join("scores.json");
    let output = Command::new("python3")
        .arg(folder.join("tools/heat_scoreboard.py"))
        .args(["--run", concat!(env!("CARGO_BIN_EXE_zelus"), " run ProjectParameters.json"), "--json"])
        .arg(&scores)
        .output()
        .expect("python3");
    let scores = read_json(&scores).unwrap_or_else(|why| panic!("{why}: {}", said(&output)));
    let decks = scores.as_object().expect("a result for each deck");
    assert!(decks.len() > 40, "{} decks", decks.len());
    let fails = |result: &Value| result["counted"] == true && result["ok"] != true;
    let failed: Vec<&str> = decks.iter().filter(|(_, result)| fails(result)).map(|(name, _)| name.as_str()).collect();
    let open: Vec<&str> = OPEN.iter().map(|(name, _)| *name).collect();
    assert_eq!(failed, open, "{}", said(&output));
}
