//! Numbering a mesh otherwise changes no result and no number of iterations: every case again with all its numbers reversed.

use crate::renumber::reversed;
use crate::support::{cases, read_json, said, scratch_copy, zelus};
use std::collections::BTreeMap;
use std::path::Path;

/// Difference allowed, relative to the largest value of the quantity.
///
/// Decks stop at relative residuals of 1e-9 and below; sums in another order differ by round-off.
const TOLERANCE: f64 = 1e-9;

/// The same for bodies that hang on one or two nodes under a light load: the forces that balance there are a difference of
/// much larger ones in the stiff body, whose round-off is 1e-8 of the pressure. Spheres in contact are such bodies in their first
/// steps, and pass it on: ten numberings of the lightest case differ by 4e-8 to 1.3e-7.
const TOLERANCE_OF_LIGHT_LOADS: f64 = 2e-7;

/// The same for [`GROWN_ROUND_OFF`].
const TOLERANCE_OF_GROWN_ROUND_OFF: f64 = 1e-7;

/// Values below are zero but for round-off; the cases are of size one.
const ZERO: f64 = 1e-18;

/// The deck whose counts are not compared, and whose results may differ by a multiple of its tolerance. The first iteration of a step
/// slides along the traction the step began with. Traction across, t, then follows t ← t (1 − K Δs / μp) with the stiffness K of the
/// body: an explicit step, which is stable up to K Δs / μp = 2, and here that is 21 (43 and 10 for steps of twice and half the length,
/// below 2 for a tenth). So the slip residual grows from round-off, 1e-13 to 1e-9, until it is above the tolerance and a second
/// iteration, which is implicit, removes it; when, is up to round-off. It never passes the tolerance.
const GROWN_ROUND_OFF: &str = "contact_3d/friction_penalty_slide";

/// Nodal histories of all results files of a folder: (file, variable) → node → values over time.
fn histories(folder: &Path) -> BTreeMap<(String, String), BTreeMap<u64, Vec<f64>>> {
    let mut found: BTreeMap<(String, String), BTreeMap<u64, Vec<f64>>> = BTreeMap::new();
    for entry in std::fs::read_dir(folder).expect("a folder").map(|e| e.expect("an entry").path()) {
        if entry.extension().is_none_or(|e| e != "json") {
            continue;
        }
        let file = entry.file_name().expect("a name").to_string_lossy().into_owned();
        let Ok(root) = read_json(&entry) else { continue };
        for (key, values) in root.as_object().into_iter().flatten() {
            let Some(id) = key.strip_prefix("NODE_").and_then(|id| id.parse().ok()) else { continue };
            for (variable, history) in values.as_object().into_iter().flatten() {
                let history = history.as_array().into_iter().flatten().filter_map(|v| v.as_f64()).collect();
                found.entry((file.clone(), variable.clone())).or_default().insert(id, history);
            }
        }
    }
    found
}

/// Runs a deck; the iterations of its steps.
fn run(folder: &Path) -> Result<Vec<usize>, String> {
    let output = zelus(folder, &["run", "ProjectParameters.json", "--report", "report.out"]);
    if !output.status.success() {
        return Err(format!("exit {:?}\n{}", output.status.code(), said(&output)));
    }
    let report = read_json(&folder.join("report.out")).expect("the report");
    let steps = report["steps"].as_array().into_iter().flatten();
    Ok(steps.map(|step| step["iterations"].as_array().map_or(0, Vec::len)).collect())
}

/// Difference between the results of a deck and of the same deck numbered otherwise.
fn difference(folder: &Path) -> Result<(), String> {
    let (one, other) = (scratch_copy(folder), scratch_copy(folder));
    let mesh = std::fs::read_dir(folder)
        .expect("a folder")
        .map(|e| e.expect("an entry").file_name())
        .find(|name| name.to_string_lossy().ends_with(".mdpa"))
        .ok_or("no mesh")?;
    let text = std::fs::read_to_string(folder.join(&mesh)).map_err(|e| e.to_string())?;
    let (ids, text) = reversed(&text);
    std::fs::write(other.path().join(&mesh), text).map_err(|e| e.to_string())?;
    let iterations = run(one.path())?;
    let again = run(other.path()).map_err(|said| format!("numbered otherwise: {said}"))?;
    let name = folder.to_string_lossy();
    if iterations != again && !name.ends_with(GROWN_ROUND_OFF) {
        return Err(format!("iterations {iterations:?}, numbered otherwise {again:?}"));
    }
    let tolerance = match () {
        () if name.contains("hertz_spheres") => TOLERANCE_OF_LIGHT_LOADS,
        () if name.ends_with(GROWN_ROUND_OFF) => TOLERANCE_OF_GROWN_ROUND_OFF,
        () => TOLERANCE,
    };
    let (one, other) = (histories(one.path()), histories(other.path()));
    if one.is_empty() {
        return Err("nothing is compared".into());
    }
    let stem = |variable: &str| variable.trim_end_matches(['X', 'Y', 'Z']).to_owned();
    let mut scale: BTreeMap<String, f64> = BTreeMap::new();
    for ((_, variable), nodes) in &one {
        let largest = scale.entry(stem(variable)).or_insert(0.0);
        *largest = nodes.values().flatten().fold(*largest, |m, v| m.max(v.abs()));
    }
    for (key, nodes) in &one {
        for (id, history) in nodes {
            let again = other.get(key).and_then(|n| n.get(&ids[id])).ok_or(format!("{key:?}: node {id} is missing"))?;
            for (step, (a, b)) in history.iter().zip(again).enumerate() {
                let allowed = (tolerance * scale[&stem(&key.1)]).max(ZERO);
                if a.is_nan() || b.is_nan() || (a - b).abs() > allowed {
                    return Err(format!("{key:?} at node {id}, step {step}: {a:e} and {b:e}, allowed {allowed:.1e}"));
                }
            }
        }
    }
    Ok(())
}

#[test]
fn reversed_numbers_change_no_result() {
    let decks = cases();
    let problems: Vec<String> = decks
        .iter()
        .filter_map(|deck| difference(deck).err().map(|problem| format!("{}: {problem}", deck.display())))
        .collect();
    assert!(problems.is_empty(), "{} of {} decks:\n{}", problems.len(), decks.len(), problems.join("\n"));
}
