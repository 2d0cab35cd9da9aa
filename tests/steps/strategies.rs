//! Line search and arc length where Newton's iteration alone fails.

use crate::support::{Results, change, root, said, scratch_copy, zelus};

const DECK: &str = "ProjectParameters.json";
/// Support and apex of the truss, cross-section times Young's modulus.
const SPAN: f64 = 1.0;
const RISE: f64 = 0.2;
const STIFFNESS: f64 = 0.02 * 1.0e6;

/// ANALYTIC: load on half of a von Mises truss whose apex is at height `y`, by Green's strain:
/// E A y (h² − y²) / (2 L³).
fn truss_load(y: f64) -> f64 {
    STIFFNESS * y * (RISE * RISE - y * y) / (2.0 * (SPAN * SPAN + RISE * RISE).powf(1.5))
}

/// Height of the apex and load there in each step. The bar is one solid element, pinned in the middle of its ends.
fn truss_path(results: &Results) -> Vec<(f64, f64)> {
    (0..results.len())
        .map(|step| {
            let u = results.nodal("DISPLACEMENT_Y", step);
            let force = results.nodal("REACTION_Y", step);
            (RISE + 0.5 * (u[&2] + u[&3]), force[&1] + force[&4])
        })
        .collect()
}

#[test]
fn arc_length_follows_a_truss_through_its_limit_points() {
    for loads in ["", "parts"] {
        let scratch = scratch_copy(&root().join("tests/decks/truss"));
        if !loads.is_empty() {
            let none = "\"loads_sub_model_part_list\": [], \"loads_variable_list\": []";
            let named = "\"loads_sub_model_part_list\": [\"Apex\"], \"loads_variable_list\": [\"POINT_LOAD\"]";
            change(scratch.path(), DECK, none, named);
        }
        let output = zelus(scratch.path(), &["run", DECK]);
        assert!(output.status.success(), "{}", said(&output));
        let path = truss_path(&Results::read(&scratch.path().join("results.json")).expect("results"));
        let limit = truss_load(RISE / 3.0_f64.sqrt());
        let mut worst: f64 = 0.0;
        for (y, load) in &path {
            worst = worst.max((load - truss_load(*y)).abs() / limit);
        }
        let before = path.iter().take_while(|(y, _)| *y > 0.0);
        let most = before.fold(0.0_f64, |most, (_, load)| most.max(*load));
        let least = path.iter().fold(0.0_f64, |least, (_, load)| least.min(*load));
        println!("limit {limit:.4}: found {most:.4} and {least:.4}, off the path by {worst:.1e}; {} steps", path.len());
        assert!(worst < 1e-7, "off the path by {worst} of the limit load");
        assert!(most > 0.95 * limit && least < -0.95 * limit, "the limit points were missed: {most}, {least}");
        let (y, load) = path.last().expect("steps");
        assert!(*y < -RISE && *load > 0.0, "the truss did not snap through: it is at {y} under {load}");
    }
}

#[test]
fn newton_alone_does_not_pass_the_limit_point() {
    let scratch = scratch_copy(&root().join("tests/decks/truss"));
    change(
        scratch.path(),
        DECK,
        "\"type\": \"arc_length\", \"advanced_settings\": {",
        "\"type\": \"newton_raphson\", \"advanced_settings\": {",
    );
    change(scratch.path(), DECK, "\"modulus\": 15.0", "\"modulus\": \"1.0*t\"");
    let output = zelus(scratch.path(), &["run", DECK]);
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
    let path = truss_path(&Results::read(&scratch.path().join("results.json")).expect("results"));
    let limit = truss_load(RISE / 3.0_f64.sqrt());
    let (y, load) = *path.last().expect("steps");
    println!("limit {limit}, last load {load} at height {y}");
    assert!(load > 0.8 * limit && load < limit && y > 0.0, "{load} {y} {limit}");
}

/// ANALYTIC: a neo-Hookean block, held sideways, under the dead load 2p on its unit width. Its stretch J obeys
/// μ (J − 1/J) + λ ln J / J = −2p. The first whole increment turns it inside out; a part of it is taken, by the line search or by Newton's
/// iteration alone. Under ten times the load no part that it tries serves that iteration: the step is tried again with the line search,
/// and where that may not be, it is cut.
#[test]
fn increments_that_turn_a_block_inside_out_are_shortened_or_the_step_is_cut() {
    let squeeze = |changes: &[(&str, &str)]| {
        let scratch = scratch_copy(&root().join("tests/decks/squeezed_block"));
        for (find, with) in changes {
            change(scratch.path(), DECK, find, with);
        }
        let output = zelus(scratch.path(), &["run", DECK]);
        (output.status.code(), Results::read(&scratch.path().join("results.json")).ok(), said(&output))
    };
    let (young, poisson) = (1.0, 0.3);
    let lambda = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    let mu = young / (2.0 * (1.0 + poisson));
    let stress = |j: f64| mu * (j - 1.0 / j) + lambda * j.ln() / j;
    let whole = ("\"time_stepping\"", "\"step_cutting\": false, \"time_stepping\"");
    let newton = ("\"type\": \"line_search\"", "\"type\": \"newton_raphson\"");
    let strategy = "\"solving_strategy_settings\": {\"type\": \"line_search\", \"advanced_settings\": {}}";
    for changes in [&[whole][..], &[whole, (strategy, "\"line_search\": true")], &[whole, newton]] {
        let (code, results, text) = squeeze(changes);
        assert_eq!(code, Some(0), "{text}");
        let stretch = 1.0 + results.expect("results").nodal("DISPLACEMENT_Y", 0)[&3];
        assert!((stress(stretch) + 3.0).abs() < 1e-7, "stretch {stretch} under the stress {}", stress(stretch));
    }
    let heavy = ("\"1.5*t\"", "\"15.0*t\"");
    let (code, _, text) = squeeze(&[whole, newton, heavy]);
    assert_eq!(code, Some(3), "{text}");
    for word in ["step 1", "in iteration 1", "TotalLagrangianElement2D4N 1", "nodes 1 2 3 4", "inside out", "Try"] {
        assert!(text.contains(word), "the message does not say {word:?}:\n{text}");
    }
    let plain = ("\"time_stepping\"", "\"line_search_after_failure\": false, \"time_stepping\"");
    for (changes, is_cut) in [(&[newton, heavy][..], false), (&[newton, heavy, plain], true)] {
        let (code, results, text) = squeeze(changes);
        assert_eq!(code, Some(0), "{text}");
        assert_eq!(text.contains("retried with a line search"), !is_cut, "{text}");
        let results = results.expect("results");
        assert_eq!(results.len() > 1, is_cut, "{text}");
        let stretch = 1.0 + results.nodal("DISPLACEMENT_Y", results.len() - 1)[&3];
        assert!((stress(stretch) + 30.0).abs() < 1e-6, "stretch {stretch}");
    }
}
