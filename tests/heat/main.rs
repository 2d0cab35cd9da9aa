//! Heat against closed forms: conduction, storage, convection, radiation; and that nothing but physics changes an answer.

#[path = "../support/blocks.rs"]
mod blocks;
mod contact;
mod damage;
mod decks;
mod explicit;
mod plastic;
mod slab;
#[path = "../support/mod.rs"]
mod support;

use serde_json::json;
use slab::{Deck, Slab, material};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use support::{Results, said, zelus};

/// The last temperature at the lower node of a column.
fn last(results: &Results, slab: &Slab, column: usize) -> f64 {
    results.nodal("TEMPERATURE", results.len() - 1)[&(slab.node(column, 0) as u64)]
}

/// A deck without storage.
fn at_rest(conductivity: f64) -> Deck {
    Deck::new("stationary", 1e12, 1e12, conductivity)
}

fn held(deck: Deck, left: f64, right: f64) -> Deck {
    deck.assign("Left", "TEMPERATURE", json!(left), true).assign("Right", "TEMPERATURE", json!(right), true)
}

#[test]
fn a_table_of_conductivity_acts() {
    let slab = Slab::new(20);
    let mut deck = held(at_rest(1.0), 100.0, 0.0).set("residual_relative_tolerance", json!(1e-12));
    deck.materials[0]["Material"]["Tables"] = json!({"k": {"input_variable": "TEMPERATURE", "output_variable": "CONDUCTIVITY",
        "data": [[0.0, 1.0], [100.0, 3.0]]}});
    let results = deck.run(&slab);
    // T + T²/100 = 200 (1 − x); linear elements are exact at the nodes for the integral of the conductivity.
    for column in 0..=20 {
        let s = 200.0 * (1.0 - column as f64 / 20.0);
        let exact = 50.0 * ((1.0 + s / 25.0).sqrt() - 1.0);
        assert!((last(&results, &slab, column) - exact).abs() < 1e-9, "{column}: {}", last(&results, &slab, column));
    }
}

#[test]
fn each_element_has_its_own_material() {
    for triangles in [false, true] {
        for element in ["EulerianConvDiff", "LaplacianElement"] {
            let slab = Slab { triangles, ..Slab::new(8) };
            let mut deck =
                held(at_rest(1.0), 100.0, 0.0).set("element_replace_settings", json!({"element_name": element}));
            deck.materials = vec![material("Near", 1, 10.0), material("Far", 2, 1.0)];
            let results = deck.run(&slab);
            assert!((last(&results, &slab, 4) - 1000.0 / 11.0).abs() < 1e-8, "{element}");
            let fed = results.nodal("REACTION_FLUX", 0);
            let flow: f64 = (0..2).map(|row| fed[&(slab.node(0, row) as u64)]).sum();
            assert!((flow - 0.1 * 10.0 * (100.0 - 1000.0 / 11.0) / 0.5).abs() < 1e-8, "{flow}");
        }
    }
}

#[test]
fn a_wall_radiates_and_convects_as_its_balance_says() {
    let slab = Slab { triangles: true, ..Slab::new(5) };
    let deck = at_rest(1.2)
        .assign("Left", "TEMPERATURE", json!(900.0), true)
        .starts(json!(300.0))
        .process(
            "apply_thermal_face_process",
            json!({"model_part_name": "Heat.Right", "ambient_temperature": 300.0, "add_ambient_radiation": true, "emissivity": 0.8,
                "add_ambient_convection": true, "convection_coefficient": 20.0}),
        )
        .set("residual_relative_tolerance", json!(1e-12));
    let results = deck.run(&slab);
    let out = |t: f64| 1.2 * (900.0 - t) - 20.0 * (t - 300.0) - 0.8 * 5.67e-8 * (t.powi(4) - 300f64.powi(4));
    let (mut low, mut high) = (300.0, 900.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if out(middle) > 0.0 { low = middle } else { high = middle }
    }
    assert!((last(&results, &slab, 5) - low).abs() < 1e-8, "{} {low}", last(&results, &slab, 5));
}

/// A sine in a slab with cold ends, by the weights θ: each step multiplies it by (1 − (1 − θ) λ Δt)/(1 + θ λ Δt), with the
/// eigenvalue λ = 6k/h² (1 − cos πh)/(2 + cos πh) of linear elements.
#[test]
fn a_sine_decays_as_scheme_and_mesh_say() {
    let slab = Slab::new(10);
    let (k, dt, steps) = (0.2, 0.05, 8);
    for theta in [0.5, 0.7, 1.0] {
        let deck = held(Deck::new("transient", dt, dt * steps as f64, k), 0.0, 0.0)
            .starts(json!("sin(3.14159265358979312*x)"))
            .set("transient_parameters", json!({"theta": theta}));
        let results = deck.run(&slab);
        let phase = (PI * 0.1).cos();
        let eigenvalue = 600.0 * k * (1.0 - phase) / (2.0 + phase);
        let factor = (1.0 - (1.0 - theta) * eigenvalue * dt) / (1.0 + theta * eigenvalue * dt);
        let exact = factor.powi(steps);
        assert!((last(&results, &slab, 5) - exact).abs() < 1e-12, "θ = {theta}: {}", last(&results, &slab, 5) - exact);
    }
}

/// A slab of one temperature, whose ends become cold: T = Σ 4/(nπ) exp(−n²π²kt) sin nπx, n odd.
#[test]
fn a_slab_cools_as_the_series_says() {
    let (k, end) = (1.0, 0.1);
    let error = |cells: usize| {
        let slab = Slab::new(cells);
        let steps = cells * cells / 10;
        let deck = held(Deck::new("transient", end / steps as f64, end, k), 0.0, 0.0)
            .starts(json!(1.0))
            .set("transient_parameters", json!({"theta": 1.0}));
        let results = deck.run(&slab);
        let series = |x: f64| -> f64 {
            let term = |n: f64| 4.0 / (n * PI) * (-(n * PI).powi(2) * k * end).exp() * (n * PI * x).sin();
            (0..20).map(|i| term(f64::from(2 * i + 1))).sum()
        };
        (last(&results, &slab, cells / 2) - series(0.5)).abs()
    };
    let [coarse, fine] = [error(20), error(40)];
    assert!(fine < 2e-3 && coarse / fine > 3.5, "{coarse:e} {fine:e}");
}

/// A boundary layer at the end that a flow meets: T = (exp(Pe x) − 1)/(exp(Pe) − 1).
#[test]
fn a_flow_makes_a_boundary_layer() {
    let error = |cells: usize| {
        let slab = Slab { triangles: true, height: 1.0 / cells as f64, ..Slab::new(cells) };
        let velocity = json!({"model_part_name": "Heat.Body", "variable_name": "VELOCITY", "value": [10.0, 0.0, 0.0],
            "constrained": false, "interval": [0.0, "End"]});
        let deck = held(Deck::new("transient", 1e9, 1e9, 1.0), 0.0, 1.0)
            .process("assign_vector_variable_process", velocity)
            .set("transient_parameters", json!({"theta": 1.0, "dynamic_tau": 0.0}));
        let results = deck.run(&slab);
        let exact = |x: f64| ((10.0 * x).exp() - 1.0) / (10f64.exp() - 1.0);
        (0..=cells).map(|c| (last(&results, &slab, c) - exact(c as f64 / cells as f64)).abs()).fold(0.0, f64::max)
    };
    let [coarse, fine] = [error(80), error(160)];
    assert!(fine < 2e-3 && coarse / fine > 3.0, "{coarse:e} {fine:e}");
}

/// Temperatures that nothing but a flow to the right carries, in semi-implicit steps.
fn carried(step: f64, end: f64, start: &str) -> Deck {
    let velocity = json!({"model_part_name": "Heat.Body", "variable_name": "VELOCITY", "value": [1.0, 0.0, 0.0],
        "constrained": false, "interval": [0.0, "End"]});
    Deck::new("transient", step, end, 1.0)
        .starts(json!(start))
        .process("assign_vector_variable_process", velocity)
        .set("time_integration_method", json!("semi_implicit"))
        .set("pure_convection", json!(true))
}

#[test]
fn paths_carry_a_slope_unchanged() {
    for triangles in [false, true] {
        let slab = Slab { triangles, ..Slab::new(20) };
        let results = carried(0.03, 0.12, "2*x").run(&slab);
        for column in 0..=20 {
            let x = column as f64 / 20.0;
            let found = last(&results, &slab, column);
            // Paths of nodes at the left begin outside of the slab, and the next steps pass on the error.
            assert!(x < 0.5 || (found - 2.0 * (x - 0.12)).abs() < 1e-12, "{x}: {found}");
        }
    }
}

#[test]
fn paths_carry_a_pulse_to_second_order() {
    let error = |cells: usize| {
        let slab = Slab { height: 1.0 / cells as f64, ..Slab::new(cells) };
        // Steps of one and a half elements.
        let steps = cells / 5;
        let results = carried(0.3 / steps as f64, 0.3, "exp(-100*(x-0.3)*(x-0.3))").run(&slab);
        let exact = |x: f64| (-100.0 * (x - 0.6).powi(2)).exp();
        (0..=cells).map(|c| (last(&results, &slab, c) - exact(c as f64 / cells as f64)).abs()).fold(0.0, f64::max)
    };
    let [coarse, fine] = [error(80), error(160)];
    assert!(fine < 1e-2 && coarse / fine > 3.5, "{coarse:e} {fine:e}");
}

/// Without a flow a semi-implicit step is one of Crank and Nicolson; sources heat as much as they give.
#[test]
fn what_is_not_carried_is_conducted_and_heated() {
    let slab = Slab::new(10);
    let (k, dt, steps) = (0.2, 0.05, 8);
    let semi = |deck: Deck| deck.set("time_integration_method", json!("semi_implicit"));
    let deck = held(Deck::new("transient", dt, dt * f64::from(steps), k), 0.0, 0.0)
        .starts(json!("sin(3.14159265358979312*x)"));
    let results = semi(deck).run(&slab);
    let phase = (PI * 0.1).cos();
    let eigenvalue = 600.0 * k * (1.0 - phase) / (2.0 + phase);
    let exact = ((1.0 - 0.5 * eigenvalue * dt) / (1.0 + 0.5 * eigenvalue * dt)).powi(steps);
    assert!((last(&results, &slab, 5) - exact).abs() < 1e-12, "{}", last(&results, &slab, 5) - exact);
    let deck = Deck::new("transient", dt, dt * f64::from(steps), k).assign("Body", "HEAT_FLUX", json!(30.0), false);
    let results = semi(deck).run(&slab);
    for column in 0..=10 {
        assert!((last(&results, &slab, column) - 12.0).abs() < 1e-11, "{}", last(&results, &slab, column));
    }
}

/// Sources, radiation and storage at once.
fn everything() -> Deck {
    Deck::new("transient", 0.02, 0.1, 1.5)
        .assign("Left", "TEMPERATURE", json!(400.0), true)
        .assign("Body", "HEAT_FLUX", json!(300.0), false)
        .assign("Right", "FACE_HEAT_FLUX", json!(-50.0), false)
        .starts(json!(300.0))
        .process(
            "apply_thermal_face_process",
            json!({"model_part_name": "Heat.Right", "ambient_temperature": 280.0, "add_ambient_radiation": true, "emissivity": 0.9}),
        )
        .set("residual_relative_tolerance", json!(1e-11))
}

#[test]
fn place_and_numbers_of_a_mesh_change_nothing() {
    let usual = Slab { rows: 2, triangles: true, ..Slab::new(9) };
    let expected = everything().run(&usual);
    for other in [Slab { angle: 0.7, ..usual }, Slab { reversed: true, ..usual }] {
        let found = everything().run(&other);
        for column in 0..=9 {
            let [a, b] = [last(&expected, &usual, column), last(&found, &other, column)];
            assert!((a - b).abs() < 1e-9 * a.abs(), "column {column}: {a} {b}");
        }
    }
}

#[test]
fn threads_change_no_bit() {
    let slab = Slab { rows: 8, ..Slab::new(80) };
    let [one, four] = ["1", "4"]
        .map(|threads| everything().run_with(&slab, &["run", "ProjectParameters.json", "--threads", threads]));
    for quantity in ["TEMPERATURE", "REACTION_FLUX"] {
        for step in 0..one.len() {
            let bits = |results: &Results| {
                results.nodal(quantity, step).values().map(|value| value.to_bits()).collect::<Vec<_>>()
            };
            assert_eq!(bits(&one), bits(&four), "{quantity}");
        }
    }
}

/// Heat that leaves and heat that is fed balance: REACTION_FLUX of the support balances sources and faces in the steady state.
#[test]
fn supports_feed_what_leaves() {
    let slab = Slab { rows: 3, ..Slab::new(6) };
    let deck = at_rest(2.0)
        .assign("Left", "TEMPERATURE", json!(10.0), true)
        .assign("Body", "HEAT_FLUX", json!(100.0), false)
        .assign("Right", "FACE_HEAT_FLUX", json!(40.0), false);
    let fed: f64 = deck.run(&slab).nodal("REACTION_FLUX", 0).values().sum();
    assert!((fed + 100.0 * 0.1 + 40.0 * 0.1).abs() < 1e-10, "{fed}");
}

/// A bar between walls that becomes warmer: u_x = 0, u_y = (1 + ν) α ΔT y in plane stress; a table of α counts as a secant.
#[test]
fn a_bar_between_walls_expands_across() {
    let slab = Slab { element: "SmallDisplacementElement", rows: 2, ..Slab::new(6) };
    let heat = Deck::new("stationary", 1e12, 1e12, 2.0).set("model_part_name", json!("Warmth")).solver;
    for (table, expansion) in [
        (json!({}), 1e-5),
        (
            json!({"a": {"input_variable": "TEMPERATURE",
        "output_variable": "THERMAL_EXPANSION_COEFFICIENT", "data": [[0.0, 1e-5], [100.0, 3e-5]]}}),
            2e-5,
        ),
    ] {
        let mut deck = Deck::new("ThermoMechanicallyCoupled", 1.0, 1.0, 2.0);
        let mut structure = deck.solver.clone();
        structure["solver_type"] = json!("Static");
        structure["model_part_name"] = json!("Heat");
        structure["material_import_settings"]["materials_filename"] = json!("law.json");
        let mut warm = heat.clone();
        warm["model_import_settings"] = json!({"input_type": "use_input_model_part"});
        deck.materials[0]["model_part_name"] = json!("Warmth.Body");
        deck.solver = json!({"solver_type": "ThermoMechanicallyCoupled", "domain_size": 2, "structural_solver_settings": structure,
            "thermal_solver_settings": warm});
        let fixed = |part: &str, component: &str| {
            json!({"python_module": "assign_scalar_variable_process", "Parameters": {
            "model_part_name": format!("Heat.{part}"), "variable_name": format!("DISPLACEMENT_{component}"), "value": 0.0}})
        };
        deck.processes = vec![fixed("Left", "X"), fixed("Right", "X"), fixed("Foot", "Y")];
        let deck = deck.process(
            "assign_scalar_variable_process",
            json!({"model_part_name": "Warmth.Body",
            "variable_name": "TEMPERATURE", "value": 50.0}),
        );
        let scratch = tempfile::tempdir().unwrap();
        deck.write(scratch.path(), &slab);
        let law = json!({"properties": [{"model_part_name": "Heat.Body", "properties_id": 1, "Material": {
            "constitutive_law": {"name": "ThermalLinearPlaneStress"}, "Tables": table, "Variables": {"DENSITY": 1.0,
            "YOUNG_MODULUS": 1e9, "POISSON_RATIO": 0.3, "THERMAL_EXPANSION_COEFFICIENT": 1e-5, "REFERENCE_TEMPERATURE": 0.0}}}]});
        std::fs::write(scratch.path().join("law.json"), law.to_string()).unwrap();
        let output = zelus(scratch.path(), &["run", "ProjectParameters.json"]);
        assert!(output.status.success(), "{}", said(&output));
        let results = Results::read(&scratch.path().join("results.json")).unwrap();
        for row in 0..=2 {
            let exact = 1.3 * expansion * 50.0 * 0.05 * row as f64;
            let u = results.nodal("DISPLACEMENT_Y", 0)[&(slab.node(3, row) as u64)];
            assert!((u - exact).abs() < 1e-15 + 1e-9 * exact, "{u} {exact}");
        }
    }
}

/// Heat passes the section of a bolt as if it were not cut.
#[test]
fn heat_passes_the_section_of_a_bolt() {
    let temperatures = [false, true].map(temperatures_of_a_bar);
    let [whole, cut] = &temperatures;
    assert!(whole.values().any(|value| (1.0..59.0).contains(value)));
    for (node, value) in whole {
        assert!((cut[node] - value).abs() < 1e-10, "{} instead of {value} at node {node}", cut[node]);
    }
}

/// Temperatures of a bar between ends at 0 and 60, with the section of a bolt or without.
fn temperatures_of_a_bar(is_cut: bool) -> BTreeMap<u64, f64> {
    let slab = Slab { element: "SmallDisplacementElement", rows: 2, ..Slab::new(6) };
    let mut warm = Deck::new("stationary", 1e12, 1e12, 2.0).set("model_part_name", json!("Warmth")).solver;
    warm["model_import_settings"] = json!({"input_type": "use_input_model_part"});
    let mut deck = Deck::new("ThermoMechanicallyCoupled", 1.0, 1.0, 2.0);
    let mut structure = deck.solver.clone();
    structure["solver_type"] = json!("Static");
    structure["material_import_settings"]["materials_filename"] = json!("law.json");
    deck.materials[0]["model_part_name"] = json!("Warmth.Body");
    deck.solver = json!({"solver_type": "ThermoMechanicallyCoupled", "domain_size": 2, "structural_solver_settings": structure,
        "thermal_solver_settings": warm});
    let assign = |part: &str, variable: &str, value: f64| {
        json!({"python_module": "assign_scalar_variable_process", "Parameters": {
        "model_part_name": part, "variable_name": variable, "value": value}})
    };
    deck.processes = vec![
        assign("Heat.Left", "DISPLACEMENT_X", 0.0),
        assign("Heat.Right", "DISPLACEMENT_X", 0.0),
        assign("Heat.Foot", "DISPLACEMENT_Y", 0.0),
        assign("Warmth.Left", "TEMPERATURE", 0.0),
        assign("Warmth.Right", "TEMPERATURE", 60.0),
    ];
    if is_cut {
        let plane = json!({"model_part_name": "Heat.Body", "point": [0.4, 0.0, 0.0], "normal": [1.0, 0.0, 0.0],
            "shortening": 0.0});
        deck = deck.process("bolt_pretension_process", plane);
    }
    let scratch = tempfile::tempdir().unwrap();
    deck.write(scratch.path(), &slab);
    let law = json!({"properties": [{"model_part_name": "Heat.Body", "properties_id": 1, "Material": {
        "constitutive_law": {"name": "LinearElasticPlaneStress2DLaw"}, "Tables": {}, "Variables": {"DENSITY": 1.0,
        "YOUNG_MODULUS": 1e9, "POISSON_RATIO": 0.3}}}]});
    std::fs::write(scratch.path().join("law.json"), law.to_string()).unwrap();
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json"]);
    assert!(output.status.success(), "{}", said(&output));
    let results = Results::read(&scratch.path().join("results.json")).unwrap();
    results.nodal("TEMPERATURE", 0)
}

#[test]
fn what_is_missing_is_said() {
    let says = |deck: &Deck, code: i32, word: &str| {
        let scratch = tempfile::tempdir().unwrap();
        deck.write(scratch.path(), &Slab::new(3));
        let output = zelus(scratch.path(), &["run", "ProjectParameters.json"]);
        assert_eq!(output.status.code(), Some(code), "{}", said(&output));
        assert!(said(&output).contains(word), "{}", said(&output));
    };
    let mut nothing = held(at_rest(1.0), 1.0, 0.0);
    nothing.materials[0]["Material"]["Variables"] = json!({"DENSITY": 1.0});
    says(&nothing, 3, "have no CONDUCTIVITY");
    let mut light = held(Deck::new("transient", 1.0, 1.0, 1.0), 1.0, 0.0);
    light.materials[0]["Material"]["Variables"] = json!({"CONDUCTIVITY": 1.0});
    says(&light, 0, "no DENSITY");
    says(
        &held(at_rest(1.0), 1.0, 0.0).set("element_replace_settings", json!({"element_name": "NoElement"})),
        2,
        "NoElement2D4N",
    );
    says(&held(at_rest(1.0), 1.0, 0.0).set("skip_entities_replace_and_check", json!(true)), 2, "has no physics");
    let theta = Deck::new("transient", 1.0, 1.0, 1.0).set("transient_parameters", json!({"theta": 0.2}));
    says(&held(theta, 1.0, 0.0), 2, "theta");
    says(&carried(0.1, 0.1, "x").set("bfecc_substepping", json!(0)), 2, "bfecc_substepping");
}

/// Heat that enters equals heat that leaves, is advected or stored, in each step.
#[test]
fn heat_that_enters_leaves_or_is_stored() {
    let slab = Slab::new(8);
    let velocity = json!({"model_part_name": "Heat.Body", "variable_name": "VELOCITY", "value": [0.5, 0.0, 0.0],
        "constrained": false, "interval": [0.0, "End"]});
    for (speed, theta) in [(false, 0.5), (false, 1.0), (true, 0.5), (true, 1.0)] {
        let mut deck = Deck::new("transient", 0.05, 0.2, 0.7)
            .assign("Left", "TEMPERATURE", json!(1.0), true)
            .assign("Body", "HEAT_FLUX", json!(2.0), false)
            .starts(json!(0.0))
            .process(
                "apply_thermal_face_process",
                json!({"model_part_name": "Heat.Right", "ambient_temperature": -0.5, "add_ambient_radiation": false,
                    "add_ambient_convection": true, "convection_coefficient": 4.0}),
            )
            .set("residual_relative_tolerance", json!(1e-13))
            .set("transient_parameters", json!({"theta": theta}));
        if speed {
            deck = deck.process("assign_vector_variable_process", velocity.clone());
        }
        let (results, report) = deck.run_and_report(&slab);
        let steps = report["steps"].as_array().expect("steps");
        assert_eq!(steps.len(), 4);
        for step in steps {
            let balance = &step["balance"]["unknowns"][0];
            let [entering, leaving, stored] =
                ["entering", "leaving", "stored"].map(|key| balance["flows"][key].as_f64().expect("a number"));
            let carried = balance["forces"]["elements"][0].as_f64().expect("a number");
            let left = entering - leaving + carried - stored;
            assert!(left.abs() < 1e-10 * entering, "{entering} {leaving} {carried} {stored}: {left:e}");
            assert!(stored.abs() > 1e-6 && leaving > 0.0 && (carried.abs() > 1e-3) == speed, "{balance}");
        }
        // The stored heat is the change of the mean.
        let balance = &steps[3]["balance"]["unknowns"][0];
        let mean = |step: usize| {
            let at = |c: usize| results.nodal("TEMPERATURE", step)[&(slab.node(c, 0) as u64)];
            (0..8).map(|c| 0.5 * (at(c) + at(c + 1)) / 8.0).sum::<f64>()
        };
        let stored = (mean(3) - mean(2)) / 0.05 * slab.height;
        assert!((balance["flows"]["stored"].as_f64().expect("a number") - stored).abs() < 1e-9, "{balance} {stored}");
    }
}

/// The steady state does not depend on the length of a step; stored heat, as in Kratos, becomes steady after long ones alone.
#[test]
fn heat_at_rest_knows_no_time() {
    let slab = Slab { height: 0.1, ..Slab::new(5) };
    let middle = |step: f64, stores: bool| {
        let deck = held(Deck::new("stationary", step, 1.0, 1.0), 0.0, 1.0).set("stores_heat", json!(stores));
        last(&deck.run(&slab), &slab, 2)
    };
    for step in [0.25, 1.0, 1e12] {
        assert!((middle(step, false) - 0.4).abs() < 1e-12, "{step}");
    }
    assert!((middle(1.0, true) - 0.4).abs() > 1e-3);
}

/// ANALYTIC: between a column at 0 and one at 1 temperatures are linear; the right end has that of the left by its period.
#[test]
fn temperatures_of_periodic_sides_are_equal() {
    let slab = Slab::new(8);
    let deck = Deck::new("stationary", 1e12, 1e12, 2.0)
        .assign("Left", "TEMPERATURE", json!(0.0), true)
        .assign("Middle", "TEMPERATURE", json!(1.0), true)
        .process(
            "apply_periodic_condition_process",
            json!({"model_part_name": "Heat", "first_model_part_name": "Left", "second_model_part_name": "Right",
                "variable_names": ["TEMPERATURE"],
                "transformation_settings": {"translation_settings": {"dir_of_translation": [1.0, 0.0, 0.0], "magnitude": 1.0}}}),
        );
    let found = deck.run(&slab).nodal("TEMPERATURE", 0);
    for (column, expected) in [(2, 0.5), (4, 1.0), (5, 1.0), (6, 2.0 / 3.0), (8, 0.0)] {
        let value = found[&(slab.node(column, 1) as u64)];
        assert!((value - expected).abs() < 1e-12, "column {column}: {value}");
    }
}
