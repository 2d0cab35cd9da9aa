//! Explicit steps of heat: their method, convection, storage and critical length.

use serde_json::{Value, json};

use crate::slab::{Deck, Slab};
use crate::{held, last};

fn explicit(deck: Deck, element: &str, orthogonal: bool) -> Deck {
    deck.set("time_integration_method", json!("explicit"))
        .set("use_orthogonal_subscales", json!(orthogonal))
        .set("element_replace_settings", json!({"element_name": element}))
}

/// The factor of a step of the classical method, 1 + z + z²/2 + z³/6 + z⁴/24.
fn factor(z: f64) -> f64 {
    1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0)))
}

/// A sine in a slab with cold ends: its eigenvalue with storage at the nodes is λ = 2k/h² (1 − cos πh). A step that is too long to be
/// stable is cut.
#[test]
fn a_sine_decays_as_runge_and_kutta_say() {
    let slab = Slab::new(10);
    let k = 0.2;
    let eigenvalue = 200.0 * k * (1.0 - (std::f64::consts::PI * 0.1).cos());
    for (asked, made, steps) in [(0.02, 0.02, 5), (0.1, 0.025, 4)] {
        let deck = held(Deck::new("transient", asked, 0.1, k), 0.0, 0.0).starts(json!("sin(3.14159265358979312*x)"));
        let results = explicit(deck, "QSConvectionDiffusionExplicit", true).run(&slab);
        assert_eq!(results.len(), steps);
        let exact = factor(-eigenvalue * made).powi(steps as i32);
        assert!((last(&results, &slab, 5) - exact).abs() < 1e-12, "{asked}: {}", last(&results, &slab, 5) - exact);
    }
}

fn flow() -> Value {
    json!({"model_part_name": "Heat.Body", "variable_name": "VELOCITY", "value": [1.0, 0.0, 0.0], "constrained": false,
        "interval": [0.0, "End"]})
}

/// The largest error of a pulse that a flow carries by 0.3.
fn error(element: &str, orthogonal: bool, cells: usize, triangles: bool) -> f64 {
    // Triangles make unlike patches along the sides of the slab, which the middle is far from.
    let rows = if triangles { 8 } else { 1 };
    let slab = Slab { height: rows as f64 / cells as f64, rows, triangles, ..Slab::new(cells) };
    let deck = Deck::new("transient", 0.3 / (cells as f64 * 0.6), 0.3, 0.0)
        .starts(json!("exp(-100*(x-0.3)*(x-0.3))"))
        .assign("Left", "TEMPERATURE", json!(0.0), true)
        .process("assign_vector_variable_process", flow());
    let results = explicit(deck, element, orthogonal).run(&slab);
    let exact = |x: f64| (-100.0 * (x - 0.6).powi(2)).exp();
    let at = results.nodal("TEMPERATURE", results.len() - 1);
    let found = |c: usize| at[&(slab.node(c, rows / 2) as u64)];
    (0..=cells).map(|c| (found(c) - exact(c as f64 / cells as f64)).abs()).fold(0.0, f64::max)
}

#[test]
fn explicit_steps_carry_a_pulse_to_second_order() {
    for element in ["QSConvectionDiffusionExplicit", "DConvectionDiffusionExplicit"] {
        for triangles in [false, true] {
            let [coarse, fine] = [80, 160].map(|cells| error(element, true, cells, triangles));
            assert!(fine < 1e-2 && coarse / fine > 3.5, "{element} {triangles}: {coarse:e} {fine:e}");
        }
    }
    let [all, orthogonal] =
        [false, true].map(|orthogonal| error("QSConvectionDiffusionExplicit", orthogonal, 80, false));
    assert!(orthogonal < all, "{orthogonal:e} {all:e}");
}

/// Heat from supports and sources equals the heat stored in nodes: in each step, to round-off.
#[test]
fn explicit_steps_lose_no_heat() {
    let slab = Slab::new(8);
    let deck = Deck::new("transient", 0.005, 0.05, 0.7)
        .assign("Left", "TEMPERATURE", json!("1+3*t"), true)
        .assign("Body", "HEAT_FLUX", json!(2.0), false)
        .starts(json!("x"));
    let results = explicit(deck, "QSConvectionDiffusionExplicit", true).run(&slab);
    let stored = |step: usize| {
        let at = |c: usize| results.nodal("TEMPERATURE", step)[&(slab.node(c, 0) as u64)];
        (0..8).map(|c| 0.5 * (at(c) + at(c + 1)) / 8.0).sum::<f64>() * slab.height
    };
    for step in 1..results.len() {
        let fed: f64 = results.nodal("REACTION_FLUX", step).values().sum();
        let gained = (stored(step) - stored(step - 1)) / 0.005;
        assert!((fed + 2.0 * slab.height - gained).abs() < 1e-10, "{step}: {fed} {gained}");
        assert!(fed.abs() > 1e-3, "{fed}");
    }
}

/// A capacity that a table lets depend on the temperature, and elements that store nothing, are refused by name.
#[test]
fn explicit_steps_say_what_they_cannot_do() {
    let refused = |deck: Deck, word: &str| {
        let scratch = tempfile::tempdir().unwrap();
        deck.write(scratch.path(), &Slab::new(3));
        let output = crate::support::zelus(scratch.path(), &["run", "ProjectParameters.json"]);
        assert_eq!(output.status.code(), Some(2), "{}", crate::support::said(&output));
        assert!(crate::support::said(&output).contains(word), "{}", crate::support::said(&output));
    };
    let mut deck = held(Deck::new("transient", 0.01, 0.01, 1.0), 0.0, 1.0);
    deck.materials[0]["Material"]["Tables"] = json!({"c": {"input_variable": "TEMPERATURE", "output_variable": "SPECIFIC_HEAT",
        "data": [[0.0, 1.0], [100.0, 3.0]]}});
    refused(explicit(deck, "QSConvectionDiffusionExplicit", true), "hold density and specific heat");
    let deck = held(Deck::new("transient", 0.01, 0.01, 1.0), 0.0, 1.0);
    refused(explicit(deck, "EulerianConvDiff", true), "stores no TEMPERATURE");
}
