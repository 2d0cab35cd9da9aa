//! How near contact comes to closed forms (ANALYTIC) on two meshes: the error falls with the size of the elements.
//!
//! The checks of a case name the nodes and the exact values; loads are so light that the neglected terms of the closed forms are less
//! than the errors of the meshes.

use crate::support::{Results, read_json, root, said, scratch_copy, zelus};
use std::collections::BTreeMap;

/// Root mean square, over the nodes of a case, of the error of each quantity relative to its largest exact value.
fn errors(case: &str) -> BTreeMap<String, f64> {
    let scratch = scratch_copy(&root().join("tests/cases/contact_2d").join(case));
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json"]);
    assert!(output.status.success(), "{case}: {}", said(&output));
    let read = read_json(&scratch.path().join("case.json")).expect("the case");
    let mut squares: BTreeMap<String, (f64, f64, f64)> = BTreeMap::new();
    let results = Results::read(&scratch.path().join("slave.json")).expect("results");
    let step = results.step(None).expect("a step");
    for check in read["checks"].as_array().expect("checks") {
        let quantity = check["quantity"].as_str().expect("a quantity");
        let exact = check["value"].as_f64().expect("a value");
        let node = check["nodes"][0].as_u64().expect("a node");
        let found = results.nodal(quantity, step)[&node];
        let (sum, count, largest) = squares.entry(quantity.to_owned()).or_default();
        *sum += (found - exact).powi(2);
        *count += 1.0;
        *largest = largest.max(exact.abs());
    }
    squares.into_iter().map(|(quantity, (sum, count, largest))| (quantity, (sum / count).sqrt() / largest)).collect()
}

#[test]
fn errors_of_curved_contact_fall_with_the_mesh() {
    for case in ["hertz_spheres_light", "cattaneo_mindlin_light"] {
        let [coarse, fine] = ["_coarse", ""].map(|mesh| errors(&format!("{case}{mesh}")));
        for (quantity, fine) in &fine {
            println!(
                "{case}, {quantity}: {:.2} % on the coarse mesh, {:.2} % on the fine one",
                100.0 * coarse[quantity],
                100.0 * fine
            );
        }
        let worst = |errors: &BTreeMap<String, f64>| errors.values().copied().fold(0.0, f64::max);
        let (coarse, fine) = (worst(&coarse), worst(&fine));
        assert!(fine < 0.6 * coarse && fine < 0.006, "{case}: {coarse:.2e}, {fine:.2e}");
    }
}
