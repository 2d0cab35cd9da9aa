//! Iterative engines on decks with multipliers: condensed systems have the answer of the whole ones, and refusals are
//! named.

use crate::support::{read_json, root, said, scratch_copy, zelus};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::Path;

const DECK: &str = "ProjectParameters.json";
const DIRECT: &str = "sparse_lu";
/// Largest difference of a field from that of the direct engine, as a share of its largest value.
const AGREE: f64 = 1e-9;

/// Outcome of a run of a case.
struct CondensedRun {
    code: Option<i32>,
    said: String,
    /// Engines of all linear solves.
    engines: Vec<String>,
    /// Numbers by result file and quantity, in one order.
    fields: BTreeMap<String, Vec<f64>>,
}

impl CondensedRun {
    /// Runs a case of `tests/cases` with an engine and a change of its deck.
    fn of(case: &str, engine: &str, change: impl FnOnce(&mut Value)) -> Self {
        let folder = root().join("tests/cases").join(case);
        let scratch = scratch_copy(&folder);
        let path = scratch.path().join(DECK);
        let mut deck = read_json(&path).expect("the deck");
        deck["solver_settings"]["linear_solver_settings"] = json!({"solver_type": engine});
        if engine != DIRECT {
            deck["solver_settings"]["linear_solver_settings"]["tolerance"] = json!(1e-12);
        }
        change(&mut deck);
        std::fs::write(&path, deck.to_string()).expect("the deck");
        let output = zelus(scratch.path(), &["run", DECK, "--report", "report.json"]);
        let report = read_json(&scratch.path().join("report.json")).unwrap_or_default();
        let steps = report["steps"].as_array().into_iter().flatten();
        let iterations = steps.flat_map(|step| step["iterations"].as_array().expect("iterations").clone());
        let engines = iterations.map(|i| i["engine"].as_str().expect("a name").to_owned()).collect();
        Self { code: output.status.code(), said: said(&output), engines, fields: fields(scratch.path(), &folder) }
    }

    /// Runs a case that is to converge.
    fn converged(case: &str, engine: &str, change: impl FnOnce(&mut Value)) -> Self {
        let run = Self::of(case, engine, change);
        assert_eq!(run.code, Some(0), "{case}, {engine}: {}", run.said);
        run
    }

    fn is_solved_by(&self, engine: &str) -> bool {
        self.engines.iter().all(|name| name == engine || name.starts_with("none"))
    }

    /// The largest difference of a field, as a share of its largest value, and which field it is.
    fn difference(&self, other: &Self) -> (f64, String) {
        assert!(self.fields.keys().eq(other.fields.keys()) && !self.fields.is_empty());
        let mut worst = (0.0, String::new());
        for (name, values) in &self.fields {
            let size = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            let differences = values.iter().zip(&other.fields[name]).map(|(a, b)| (a - b).abs());
            let share = differences.fold(0.0, f64::max) / size;
            if share > worst.0 {
                worst = (share, name.clone());
            }
        }
        worst
    }
}

/// The deck as it is written.
fn as_it_is(_: &mut Value) {}

/// Sets a key of `contact_settings`.
fn set(deck: &mut Value, key: &str, value: bool) {
    deck["solver_settings"]["contact_settings"][key] = json!(value);
}

/// Displacements and multipliers in the result files that `folder` has more than `case`; components count together.
fn fields(folder: &Path, case: &Path) -> BTreeMap<String, Vec<f64>> {
    let mut found: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for entry in std::fs::read_dir(folder).expect("a folder").map(|e| e.expect("an entry")) {
        let name = entry.file_name().into_string().expect("a name");
        if !name.ends_with(".json") || name == "report.json" || case.join(&name).exists() {
            continue;
        }
        let results = read_json(&entry.path()).expect("results");
        for (_, node) in results.as_object().expect("an object").iter().filter(|(key, _)| key.starts_with("NODE_")) {
            for (quantity, series) in node.as_object().expect("quantities") {
                let known = ["DISPLACEMENT", "LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", "VECTOR_LAGRANGE_MULTIPLIER"];
                if let Some(field) = known.iter().find(|field| quantity.starts_with(**field)) {
                    let values = series.as_array().into_iter().flatten().filter_map(Value::as_f64);
                    found.entry(format!("{name} {field}")).or_default().extend(values);
                }
            }
        }
    }
    // A field of zeros has no size to measure against.
    found.retain(|_, values| values.iter().any(|v| v.abs() > 1e-13));
    found
}

/// Scalar and vector multipliers without friction, stick, ties, self-contact, contact that opens, in the plane and in
/// space.
#[test]
fn condensed_systems_have_the_answer_of_the_direct_engine() {
    for case in [
        "contact_2d/nonmatching",
        "contact_2d/closing_gap",
        "contact_2d/opening",
        "contact_2d/slope",
        "contact_2d/free_sides",
        "contact_2d/three_blocks",
        "contact_2d/friction_stick",
        "contact_2d/friction_tresca_stick",
        "contact_2d/friction_arc",
        "contact_2d/friction_slide_millimetres",
        "contact_3d/hexahedra_nonmatching",
        "contact_3d/tetrahedra_on_hexahedra",
        "contact_3d/opening",
        "contact_3d/slope_tetrahedra",
        "contact_3d/open_sides_in_steps",
        "contact_3d/friction_stick",
        "mesh_tying/coarse_slave",
        "mesh_tying/hexahedra",
        "mesh_tying/tetrahedra_on_hexahedra",
        "self_contact/slit_components",
        "self_contact/slit_tetrahedra",
    ] {
        let direct = CondensedRun::converged(case, DIRECT, as_it_is);
        let condensed = CondensedRun::converged(case, "gmres", as_it_is);
        assert!(condensed.is_solved_by("gmres, condensed"), "{case}: {:?}", condensed.engines);
        let (difference, field) = direct.difference(&condensed);
        assert!(difference < AGREE, "{case}: {field} differs by {difference:e}");
    }
}

#[test]
fn components_and_perturbed_lagrangian_condense_too() {
    let case = "contact_3d/hexahedra_nonmatching";
    for (formulation, module, kind, multiplier) in [
        (
            "ALMContactFrictionlessComponents",
            "alm_contact_process",
            "FrictionlessComponents",
            "VECTOR_LAGRANGE_MULTIPLIER",
        ),
        (
            "PerturbedLagrangianContactFrictionless",
            "perturbed_lagrangian_contact_process",
            "Frictionless",
            "LAGRANGE_MULTIPLIER_CONTACT_PRESSURE",
        ),
    ] {
        let change = |deck: &mut Value| {
            deck["solver_settings"]["contact_settings"]["mortar_type"] = json!(formulation);
            let process = &mut deck["processes"]["contact_process_list"][0];
            process["python_module"] = json!(module);
            process["Parameters"]["contact_type"] = json!(kind);
            for output in deck["processes"]["json_output_process_list"].as_array_mut().expect("outputs") {
                if output["Parameters"]["output_file_name"] == "slave.json" {
                    output["Parameters"]["output_variables"] = json!([multiplier]);
                }
            }
        };
        let direct = CondensedRun::converged(case, DIRECT, change);
        let condensed = CondensedRun::converged(case, "bicgstab", change);
        assert!(condensed.is_solved_by("gmres, condensed"), "{formulation}: {:?}", condensed.engines);
        let (difference, field) = direct.difference(&condensed);
        assert!(difference < AGREE, "{formulation}: {field} differs by {difference:e}");
    }
}

/// Every kind of multiplier, with and without friction, held ones and those of slivers among them.
#[test]
fn multigrid_has_the_answer_of_the_direct_engine() {
    for case in [
        "contact_2d/nonmatching",
        "contact_2d/opening",
        "contact_2d/slope",
        "contact_2d/free_sides",
        "contact_2d/friction_stick",
        "contact_2d/friction_slide_millimetres",
        "contact_2d/friction_arc",
        "contact_3d/hexahedra_nonmatching",
        "contact_3d/hexahedra_on_tetrahedra",
        "contact_3d/tetrahedra_on_hexahedra",
        "contact_3d/slope_tetrahedra",
        "contact_3d/friction_stick",
        "mesh_tying/coarse_slave",
        "mesh_tying/hexahedra",
        "self_contact/slit_components",
    ] {
        let direct = CondensedRun::converged(case, DIRECT, as_it_is);
        let multigrid = CondensedRun::converged(case, "amgcl", |deck| {
            deck["solver_settings"]["linear_solver_settings"]["direct_below"] = json!(0);
        });
        assert!(multigrid.is_solved_by("multigrid"), "{case}: {:?}", multigrid.engines);
        let (difference, field) = direct.difference(&multigrid);
        assert!(difference < AGREE, "{case}: {field} differs by {difference:e}");
    }
}

/// The limit stands for the memory of the machine: 1.6 megabytes hold the levels of multigrid, and no factors.
#[test]
fn a_run_that_does_not_fit_takes_multigrid_or_ends_before_it_starts() {
    let case = "contact_3d/friction_stick";
    let limited = |gigabytes: f64| {
        CondensedRun::of(case, DIRECT, move |deck| {
            deck["solver_settings"]["linear_solver_settings"]["memory_limit"] = json!(gigabytes);
        })
    };
    let run = limited(0.0016);
    assert!(run.said.contains("warning[memory] ProjectParameters.json:"), "{}", run.said);
    assert!(run.is_solved_by("multigrid"), "{:?}", run.engines);
    let (difference, field) = CondensedRun::converged(case, DIRECT, as_it_is).difference(&run);
    assert!(difference < AGREE, "{field} differs by {difference:e}");

    let refused = limited(0.001);
    assert_eq!(refused.code, Some(2), "{}", refused.said);
    assert!(refused.said.contains("error[memory]") && refused.said.contains("nothing was run"), "{}", refused.said);
    assert!(!limited(10.0).said.contains("[memory]"));
}

/// Gradients serve while nothing touches, GMRES stands in where contact leaves no symmetry.
#[test]
fn conjugate_gradients_go_as_far_as_symmetry() {
    let run = CondensedRun::converged("contact_2d/closing_gap", "cg", as_it_is);
    assert!(run.engines.contains(&"gmres, condensed".to_owned()), "{:?}", run.engines);
    let (difference, field) = CondensedRun::converged("contact_2d/closing_gap", DIRECT, as_it_is).difference(&run);
    assert!(difference < AGREE, "{field} differs by {difference:e}");
}

#[test]
fn without_condensation_the_whole_system_is_iterated_on() {
    let run = CondensedRun::converged("contact_3d/hexahedra_nonmatching", "gmres", |deck| {
        set(deck, "use_mixed_ulm_solver", false)
    });
    assert!(run.is_solved_by("gmres"), "{:?}", run.engines);
}

/// Facets that overlap by slivers have standard functions, whose D is not diagonal by node; a node that is held across the
/// interface does not determine its multiplier.
#[test]
fn what_cannot_be_condensed_is_named_once_and_solved_whole() {
    for (case, names) in [
        (
            "contact_3d/hexahedra_on_tetrahedra",
            &["LAGRANGE_MULTIPLIER_CONTACT_PRESSURE of node", " acts on DISPLACEMENT_"],
        ),
        ("mesh_tying/hexahedra_on_tetrahedra", &["VECTOR_LAGRANGE_MULTIPLIER_", " acts on DISPLACEMENT_"]),
        (
            "contact_2d/standing_on_corner",
            &["the free unknowns of its node have", " of LAGRANGE_MULTIPLIER_CONTACT_PRESSURE"],
        ),
    ] {
        let direct = CondensedRun::converged(case, DIRECT, as_it_is);
        let run = CondensedRun::converged(case, "gmres", as_it_is);
        assert_eq!(
            run.said.matches("warning[not-condensed] ProjectParameters.json:").count(),
            1,
            "{case}: {}",
            run.said
        );
        for name in names {
            assert!(run.said.contains(name), "{case}: {name:?} is not in {}", run.said);
        }
        // Condensation ends with the first system that it does not fit.
        assert_eq!(run.engines.len(), direct.engines.len(), "{case}");
        assert_eq!(run.engines.last(), direct.engines.last(), "{case}");
        let (difference, field) = direct.difference(&run);
        assert!(difference < AGREE, "{case}: {field} differs by {difference:e}");

        let strict = CondensedRun::of(case, "gmres", |deck| set(deck, "fallback_if_dual_lm_not_valid", false));
        assert_eq!(strict.code, Some(4), "{case}: {}", strict.said);
        assert!(
            strict.said.contains("cannot be condensed") && strict.said.contains("name a direct engine"),
            "{}",
            strict.said
        );
    }
    let direct = CondensedRun::converged("contact_3d/hexahedra_on_tetrahedra", DIRECT, as_it_is);
    assert!(!direct.said.contains("not-condensed"), "{}", direct.said);
}
