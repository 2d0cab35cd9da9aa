//! The decks of heat with known answers, which stand outside of the repository: `ZELUS_HEAT_DECKS` in the environment names their folder.

use crate::support::{read_json, root, said};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Counted decks that do not pass by our defaults, and why; they pass with `--like kratos`.
const OPEN: &[(&str, &str)] = &[
    ("conv_diff_tests/bar_explicit_QASGS", "steps too long to be stable"),
    ("kratos_thermomech_tests/coupled_accessor", "gradients of quadrilaterals at their centre"),
    ("own_conduction/slab_radiation_one_linear_step", "radiation is iterated until the slab is in balance"),
    ("own_contact/transient_heating_contact_tri", "contact of Kratos"),
    (
        "own_convection/skew_discontinuity_crosswind",
        "reactions of the diffusion that was solved with, temperatures agree",
    ),
    ("own_thermomech/dynamic_lower_case", BY_TURNS),
    ("own_thermomech/moving_mesh_conduction", BY_TURNS),
    ("own_thermomech/total_lagrangian_gradient", BY_TURNS),
    ("own_thermomech/transient_block_tet", BY_TURNS),
];
const BY_TURNS: &str = "heat on the mesh as the last step left it, not staggered";

fn folder() -> Option<PathBuf> {
    let named = std::env::var_os("ZELUS_HEAT_DECKS").map(PathBuf::from);
    let folder = named.unwrap_or_else(|| root().join("../shared/heat"));
    let there = folder.join("tools/heat_scoreboard.py").is_file();
    if !there {
        println!("skipped: {} has no decks of heat", folder.display());
    }
    there.then_some(folder)
}

/// The counted decks that do not pass, and the output.
fn failed(folder: &Path, like: &str) -> (Vec<String>, String) {
    let scratch = tempfile::tempdir().expect("a scratch folder");
    let scores = scratch.path().join("scores.json");
    let run = format!("{} run ProjectParameters.json{like}", env!("CARGO_BIN_EXE_zelus"));
    let output = Command::new("python3")
        .arg(folder.join("tools/heat_scoreboard.py"))
        .args(["--run", &run, "--json"])
        .arg(&scores)
        .output()
        .expect("python3");
    let scores = read_json(&scores).unwrap_or_else(|why| panic!("{why}: {}", said(&output)));
    let decks = scores.as_object().expect("a result for each deck");
    assert!(decks.len() > 40, "{} decks", decks.len());
    let fails = |result: &Value| result["counted"] == true && result["ok"] != true;
    (decks.iter().filter(|(_, result)| fails(result)).map(|(name, _)| name.clone()).collect(), said(&output))
}

#[test]
fn every_deck_has_its_known_answer() {
    let Some(folder) = folder() else { return };
    let (by_defaults, text) = failed(&folder, "");
    assert_eq!(by_defaults, OPEN.iter().map(|(name, _)| *name).collect::<Vec<_>>(), "{text}");
    let (like_kratos, text) = failed(&folder, " --like kratos");
    assert!(like_kratos.is_empty(), "{text}");
}
