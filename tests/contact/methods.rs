//! Methods of contact against closed forms (ANALYTIC): convergence of Uzawa's iteration, the gap of a perturbed Lagrangian, rebound of
//! a bar in explicit and implicit steps.

use crate::support::{Results, change, read_json, root, said, scratch_copy, zelus};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::Path;

const DECK: &str = "ProjectParameters.json";

fn case(name: &str) -> tempfile::TempDir {
    scratch_copy(&root().join("tests/cases").join(name))
}

/// Runs the deck of a folder; returns the output.
fn run(folder: &Path) -> String {
    let output = zelus(folder, &["run", DECK]);
    assert!(output.status.success(), "{}", said(&output));
    said(&output)
}

/// The last number after `name` in the output of a run.
fn number_after(said: &str, name: &str) -> f64 {
    let (_, rest) = said.rsplit_once(name).unwrap_or_else(|| panic!("{name:?} is not in\n{said}"));
    let word: String = rest.trim_start().chars().take_while(|c| !c.is_whitespace() && *c != ',').collect();
    word.parse().unwrap_or_else(|_| panic!("{word:?} after {name:?}"))
}

fn write_json(path: &Path, value: &Value) {
    std::fs::write(path, serde_json::to_string_pretty(value).expect("JSON")).expect("a file");
}

/// Stiffness of the confined stack of `contact_2d/uzawa` per area, 1/(1/M₁ + 1/M₂).
fn stack_stiffness() -> f64 {
    let oedometer = |young: f64, poisson: f64| young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    1.0 / (1.0 / oedometer(2.0e9, 0.3) + 1.0 / oedometer(1.0e9, 0.2))
}

/// The penalty is a spring of stiffness ε by area: each update leaves the share q = K/(K + ε) of the error.
#[test]
fn uzawa_converges_linearly_at_the_rate_of_the_penalty() {
    let stiffness = stack_stiffness();
    for share in [1.0, 3.0] {
        let scratch = case("contact_2d/uzawa");
        let mut deck = read_json(&scratch.path().join(DECK)).expect("the deck");
        let process = &mut deck["processes"]["contact_process_list"][0]["Parameters"];
        process["advance_ALM_parameters"]["penalty"] = json!(share * stiffness);
        process["uzawa_parameters"] = json!({"multiplier_tolerance": 1e-6});
        write_json(&scratch.path().join(DECK), &deck);
        let said = run(scratch.path());
        let q: f64 = 1.0 / (1.0 + share);
        // The change of update i over the multipliers after it is (1 - q) q^(i-1)/(1 - q^i).
        let expected = (1..).find(|&i| (1.0 - q) * q.powi(i - 1) / (1.0 - q.powi(i)) <= 1e-6).expect("an end") - 1;
        let (rate, updates) = (number_after(&said, ", rate"), number_after(&said, "multiplier updates"));
        assert!((rate - q).abs() < 2e-3 * q, "rate {rate}, expected {q}\n{said}");
        assert_eq!(updates, f64::from(expected), "{said}");
    }
}

#[test]
fn uzawa_says_when_its_updates_are_spent() {
    let scratch = case("contact_2d/uzawa");
    change(scratch.path(), DECK, "\"multiplier_tolerance\"", "\"max_multiplier_updates\": 2, \"multiplier_tolerance\"");
    let output = zelus(scratch.path(), &["run", DECK]);
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
    assert!(said(&output).contains("after 2 updates"), "{}", said(&output));
}

/// The pressure is ε times the gap: with the stack's stiffness K, K d ε/(K + ε) under a closing of d.
#[test]
fn a_perturbed_lagrangian_yields_like_a_spring() {
    let stiffness = stack_stiffness();
    for share in [1.0, 100.0] {
        let scratch = case("contact_2d/uzawa");
        let deck = std::fs::read_to_string(scratch.path().join(DECK)).expect("the deck");
        let deck = deck
            .replace("uzawa_contact_process", "perturbed_lagrangian_contact_process")
            .replace("UzawaContactFrictionless", "PerturbedLagrangianContactFrictionless");
        let mut deck: Value = serde_json::from_str(&deck).expect("JSON");
        let process = &mut deck["processes"]["contact_process_list"][0]["Parameters"];
        process["advance_ALM_parameters"]["penalty"] = json!(share * stiffness);
        process.as_object_mut().expect("an object").remove("uzawa_parameters");
        write_json(&scratch.path().join(DECK), &deck);
        run(scratch.path());
        let results = Results::read(&scratch.path().join("slave.json")).expect("results");
        let step = results.step(None).expect("a step");
        let expected = -stiffness * 1e-3 * share / (1.0 + share);
        for (node, found) in results.nodal("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", step) {
            assert!((found / expected - 1.0).abs() < 1e-6, "node {node}: {found}, expected {expected}");
        }
    }
}

/// The penetration ends at the bound that the first penalty, too soft or too stiff, left it beyond (eq. D.4). Facets are a
/// third long, and so are the bounds over their factors. It gets there linearly, at the rate of penetration over closing.
#[test]
fn an_adapted_penalty_brings_the_penetration_between_its_bounds() {
    let stiffness = stack_stiffness();
    for (share, expected) in [(1e-1, 9e-4 / 3.0), (1e6, 9e-5 / 3.0)] {
        let scratch = case("contact_2d/uzawa");
        let deck = std::fs::read_to_string(scratch.path().join(DECK)).expect("the deck");
        let deck = deck
            .replace("uzawa_contact_process", "penalty_contact_process")
            .replace("UzawaContactFrictionless", "PenaltyContactFrictionless")
            .replace("\"LAGRANGE_MULTIPLIER_CONTACT_PRESSURE\", ", "")
            .replace("\"max_iteration\": 20", "\"max_iteration\": 40");
        let mut deck: Value = serde_json::from_str(&deck).expect("JSON");
        let process = &mut deck["processes"]["contact_process_list"][0]["Parameters"];
        process.as_object_mut().expect("an object").remove("uzawa_parameters");
        process["advance_ALM_parameters"] = json!({
            "manual_ALM": true, "penalty": share * stiffness, "adapt_penalty": true,
            "adaptation_rule": "APM", "min_gap_factor": 9e-5, "max_gap_factor": 9e-4,
        });
        write_json(&scratch.path().join(DECK), &deck);
        let said = run(scratch.path());
        let found = number_after(&said, "deepest penetration");
        assert!((found / expected - 1.0).abs() < 1e-6, "penalty {share} K: {found}, expected {expected}\n{said}");
    }
}

/// Algorithm 7 as the reference program runs it and as it is printed: a penalty that is too soft grows until the penetration is within
/// the limit, and multipliers are the same without it.
#[test]
fn an_adapted_augmented_lagrangian_ends_within_its_limit_or_where_it_would_have_ended() {
    let stiffness = stack_stiffness();
    for rule in ["AALM", "printed"] {
        for penalty in [true, false] {
            let scratch = case("contact_2d/uzawa");
            let (process, formulation) = if penalty {
                ("penalty_contact_process", "PenaltyContactFrictionless")
            } else {
                ("alm_contact_process", "ALMContactFrictionless")
            };
            let deck = std::fs::read_to_string(scratch.path().join(DECK)).expect("the deck");
            let deck = deck.replace("uzawa_contact_process", process).replace("UzawaContactFrictionless", formulation);
            let mut deck: Value = serde_json::from_str(&deck).expect("JSON");
            for output in deck["processes"]["json_output_process_list"].as_array_mut().expect("a list") {
                let variables = output["Parameters"]["output_variables"].as_array_mut().expect("a list");
                variables.retain(|name| !penalty || name != "LAGRANGE_MULTIPLIER_CONTACT_PRESSURE");
            }
            let process = &mut deck["processes"]["contact_process_list"][0]["Parameters"];
            process.as_object_mut().expect("an object").remove("uzawa_parameters");
            process["advance_ALM_parameters"] = json!({
                "manual_ALM": true, "penalty": 0.1 * stiffness, "adapt_penalty": true, "adaptation_rule": rule,
                "max_gap_factor": 3e-4,
            });
            write_json(&scratch.path().join(DECK), &deck);
            let said = run(scratch.path());
            if penalty {
                let found = number_after(&said, "deepest penetration");
                assert!(found > 0.0 && found <= 1e-4 * (1.0 + 1e-6), "{rule}: {found}\n{said}");
            } else {
                let results = Results::read(&scratch.path().join("slave.json")).expect("results");
                let step = results.step(None).expect("a step");
                for (node, found) in results.nodal("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", step) {
                    let expected = -stiffness * 1e-3;
                    assert!((found / expected - 1.0).abs() < 1e-6, "{rule}, node {node}: {found}, expected {expected}");
                }
            }
        }
    }
}

/// The penalty of each process is its factor times E/h of the softer side, E = 1e9 and h = 1/3.
#[test]
fn each_process_has_its_penalty() {
    for (process, formulation, expected) in [
        ("penalty", "Penalty", 3e13),
        ("uzawa", "Uzawa", 3e10),
        ("perturbed_lagrangian", "PerturbedLagrangian", 3e13),
        ("alm", "ALM", 3e9),
    ] {
        let scratch = case("contact_2d/uzawa");
        let deck = std::fs::read_to_string(scratch.path().join(DECK)).expect("the deck");
        let deck = deck.replace("uzawa_contact", &format!("{process}_contact")).replace("Uzawa", formulation);
        let mut deck: Value = serde_json::from_str(&deck).expect("JSON");
        let parameters = &mut deck["processes"]["contact_process_list"][0]["Parameters"];
        let settings = parameters.as_object_mut().expect("an object");
        settings.remove("advance_ALM_parameters");
        if process != "uzawa" {
            settings.remove("uzawa_parameters");
        }
        let output = &mut deck["processes"]["json_output_process_list"];
        output.as_array_mut().expect("a list").retain(|o| o["Parameters"]["output_file_name"] == "slave.json");
        output[0]["Parameters"]["output_variables"] = json!(["INITIAL_PENALTY"]);
        output[0]["Parameters"]["historical_value"] = json!(false);
        write_json(&scratch.path().join(DECK), &deck);
        run(scratch.path());
        let results = Results::read(&scratch.path().join("slave.json")).expect("results");
        for (node, found) in results.nodal("INITIAL_PENALTY", results.step(None).expect("a step")) {
            assert!((found / expected - 1.0).abs() < 1e-9, "{process}, node {node}: {found:e}, expected {expected:e}");
        }
    }
}

/// A large penalty divides the smallest eigenvalue of nothing and multiplies the largest: κ grows in proportion.
#[test]
fn the_condition_number_is_computed_and_grows_with_the_penalty() {
    let condition = |penalty: f64| {
        let scratch = case("contact_2d/uzawa");
        let deck = std::fs::read_to_string(scratch.path().join(DECK)).expect("the deck");
        let deck = deck.replace("uzawa_contact_process", "penalty_contact_process").replace("Uzawa", "Penalty");
        let mut deck: Value = serde_json::from_str(&deck).expect("JSON");
        let process = &mut deck["processes"]["contact_process_list"][0]["Parameters"];
        process["advance_ALM_parameters"] =
            json!({"manual_ALM": true, "penalty": penalty, "penalty_of_weighted_gaps": true});
        process.as_object_mut().expect("an object").remove("uzawa_parameters");
        let lists = deck["processes"].as_object_mut().expect("lists");
        lists.remove("json_output_process_list");
        deck["solver_settings"]["contact_settings"]["condn_convergence_criterion"] = json!(true);
        write_json(&scratch.path().join(DECK), &deck);
        number_after(&run(scratch.path()), "condition number")
    };
    let (soft, stiff) = (condition(1e14), condition(1e16));
    assert!((stiff / soft / 100.0 - 1.0).abs() < 0.02, "{soft:e} and {stiff:e}");
}

/// Table 4.2 with bodies that have its plateau: the valley, κ at k = ε = 100 and the row k = 1 over three decades.
#[test]
fn condition_numbers_are_those_of_table_4_2() {
    let condition = |scale_factor: f64, penalty: f64| {
        let scratch = scratch_copy(&root().join("examples/condition_number"));
        let mut deck = read_json(&scratch.path().join(DECK)).expect("the deck");
        deck.as_object_mut().expect("an object").remove("output_processes");
        let parameters = &mut deck["processes"]["contact_process_list"][0]["Parameters"]["advance_ALM_parameters"];
        (parameters["scale_factor"], parameters["penalty"]) = (json!(scale_factor), json!(penalty));
        write_json(&scratch.path().join(DECK), &deck);
        number_after(&run(scratch.path()), "condition number")
    };
    for (scale_factor, penalty, printed, least, most) in [
        (100.0, 100.0, 1.74e4, 0.97, 1.03),
        (10.0, 1e-12, 1.74e4, 0.97, 1.03),
        (10.0, 10.0, 1.74e4, 0.97, 1.03),
        (100.0, 1e-12, 1.74e4, 0.97, 1.03),
        (1.0, 1e-12, 1.13e5, 0.5, 2.0),
        (1.0, 100.0, 1.63e5, 0.5, 2.0),
        (1.0, 1e3, 6.15e5, 0.5, 2.0),
        (1.0, 1e4, 2.69e7, 0.5, 2.0),
        (1e3, 1e-12, 6.60e4, 0.8, 1.25),
        (1e4, 1e-12, 6.64e5, 0.8, 1.25),
    ] {
        let found = condition(scale_factor, penalty) / printed;
        assert!(least < found && found < most, "k = {scale_factor}, ε = {penalty}: {found} of the printed {printed:e}");
    }
}

/// κ of the first system, K small displacements in the initial state: EXTERNAL, dense eigenvalues of [K + ε B, k Nᵀ; k N, 0] by numpy,
/// given to four digits.
#[test]
fn condition_numbers_are_those_of_the_symmetric_matrix() {
    for (scale_factor, penalty, exact) in
        [(100.0, 1e3, 2.488e4), (1e3, 1e3, 6.785e4), (1e3, 1e4, 2.125e5), (1e4, 1e4, 6.582e5)]
    {
        let scratch = scratch_copy(&root().join("examples/condition_number"));
        let mut deck = read_json(&scratch.path().join(DECK)).expect("the deck");
        deck.as_object_mut().expect("an object").remove("output_processes");
        let parameters = &mut deck["processes"]["contact_process_list"][0]["Parameters"]["advance_ALM_parameters"];
        (parameters["scale_factor"], parameters["penalty"]) = (json!(scale_factor), json!(penalty));
        write_json(&scratch.path().join(DECK), &deck);
        let said = run(scratch.path());
        let (_, first) = said.split_once("condition number").expect("a condition number");
        let first: f64 =
            first.split_whitespace().next().and_then(|word| word.trim_end_matches(',').parse().ok()).expect("a number");
        assert!((first / exact - 1.0).abs() < 5e-4, "k = {scale_factor}, ε = {penalty}: {first:e} for {exact:e}");
    }
}

#[test]
fn contact_that_is_asked_for_must_be_there() {
    let scratch = case("contact_2d/uzawa");
    change(scratch.path(), DECK, "\"-0.001*t\"", "\"0.001*t\"");
    change(scratch.path(), DECK, "\"mortar_type\"", "\"ensure_contact\": true, \"mortar_type\"");
    let output = zelus(scratch.path(), &["run", DECK]);
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
    assert!(said(&output).contains("ensure_contact"), "{}", said(&output));
}

/// Impact of a bar of length 1 on a wall: wave speed 1, density 1, speed 0.01, gap 0.001.
struct Impact {
    /// Displacement of the bar's centre of mass at the end, over the exact one.
    displacement: f64,
    /// Kinetic energy at the end over that of the start.
    energy: f64,
    /// Output of the program.
    said: String,
}

/// The deck of an impact at a speed.
fn write_impact(method: &str, elements: usize, time_step: f64, speed: f64, springs: Value) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let (n, h) = (elements, 1.0 / elements as f64);
    let mut mesh =
        String::from("Begin ModelPartData\nEnd ModelPartData\n\nBegin Properties 0\nEnd Properties\n\nBegin Nodes\n");
    // The wall below y = 0, then the bar, two nodes a level.
    let (width, gap) = (h, 1e-3);
    let levels: Vec<f64> = [-0.2, 0.0].into_iter().chain((0..=n).map(|i| gap + i as f64 * h)).collect();
    for (level, y) in levels.iter().enumerate() {
        let out = if level < 2 { 0.2 * width } else { 0.0 };
        writeln!(mesh, "{} {:e} {y:e} 0\n{} {:e} {y:e} 0", 2 * level + 1, -out, 2 * level + 2, width + out).unwrap();
    }
    mesh += "End Nodes\n\nBegin Elements SmallDisplacementElement2D4N\n1 0 1 2 4 3\n";
    for i in 0..n {
        let a = 5 + 2 * i;
        writeln!(mesh, "{} 0 {a} {} {} {}", i + 2, a + 1, a + 3, a + 2).unwrap();
    }
    mesh += "End Elements\n\nBegin Conditions LineCondition2D2N\n1 0 4 3\n2 0 5 6\nEnd Conditions\n\nBegin NodalData VELOCITY_Y\n";
    let bar: Vec<usize> = (5..=2 * levels.len()).collect();
    bar.iter().for_each(|node| writeln!(mesh, "{node} 0 {}", -speed).unwrap());
    mesh += "End NodalData\n";
    let list = |ids: &[usize]| ids.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
    let elements: Vec<usize> = (2..n + 2).collect();
    for (name, nodes, elements, conditions) in [
        ("Wall", vec![1, 2, 3, 4], vec![1], vec![1]),
        ("Bar", bar.clone(), elements, vec![2]),
        ("Slave", vec![5, 6], vec![], vec![2]),
        ("Interface", vec![3, 4, 5, 6], vec![], vec![1, 2]),
    ] {
        write!(mesh, "\nBegin SubModelPart {name}\nBegin SubModelPartNodes\n{}\nEnd SubModelPartNodes\n", list(&nodes))
            .unwrap();
        if !elements.is_empty() {
            write!(mesh, "Begin SubModelPartElements\n{}\nEnd SubModelPartElements\n", list(&elements)).unwrap();
        }
        write!(
            mesh,
            "Begin SubModelPartConditions\n{}\nEnd SubModelPartConditions\nEnd SubModelPart\n",
            list(&conditions)
        )
        .unwrap();
    }
    std::fs::write(folder.path().join("mesh.mdpa"), mesh).expect("the mesh");
    let material = |part: &str, id: usize| {
        json!({"model_part_name": format!("Structure.{part}"), "properties_id": id, "Material": {
            "constitutive_law": {"name": "LinearElasticPlaneStrain2DLaw"},
            "Variables": {"YOUNG_MODULUS": 1.0, "POISSON_RATIO": 0.0, "DENSITY": 1.0}, "Tables": {}}})
    };
    let materials = json!({"properties": [material("Wall", 1), material("Bar", 2)]});
    write_json(&folder.path().join("StructuralMaterials.json"), &materials);
    let fixed = |part: &str, along: bool| {
        json!({"python_module": "assign_vector_variable_process", "kratos_module": "KratosMultiphysics", "Parameters": {
            "model_part_name": format!("Structure.{part}"), "variable_name": "DISPLACEMENT",
            "constrained": [true, along, true], "value": [0.0, if along { json!(0.0) } else { Value::Null }, 0.0],
            "interval": [0.0, "End"]}})
    };
    let explicit = method == "explicit";
    // Impact at 0.1, release at 2.1, the end at 2.6: the centre of mass is back by 0.005 from the wall.
    let end = 2.6;
    let deck = json!({
        "problem_data": {"problem_name": "impact", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0,
            "end_time": end},
        "solver_settings": {
            "solver_type": "Dynamic", "model_part_name": "Structure", "domain_size": 2, "echo_level": 0,
            "time_integration_method": method,
            "scheme_type": if explicit { "central_differences" } else { "bossak" },
            "model_import_settings": {"input_type": "mdpa", "input_filename": "mesh"},
            "material_import_settings": {"materials_filename": "StructuralMaterials.json"},
            "contact_settings": {
                "mortar_type": if explicit { "PenaltyContactFrictionless" } else { "ALMContactFrictionless" },
                "delta_time_factor_for_contact": 1.0},
            "time_stepping": {"time_step": time_step}},
        "processes": {
            "constraints_process_list": [fixed("Wall", true), fixed("Bar", false)],
            "contact_process_list": [{
                "python_module": if explicit { "explicit_penalty_contact_process" } else { "alm_contact_process" },
                "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication", "Parameters": {
                    "model_part_name": "Structure", "contact_type": "Frictionless",
                    "contact_model_part": {"0": ["Interface"]}, "assume_master_slave": {"0": ["Slave"]},
                    "search_parameters": {"search_factor": 20.0}, "advance_ALM_parameters": springs}}],
            "json_output_process_list": [{"python_module": "json_output_process", "kratos_module": "KratosMultiphysics",
                "Parameters": {"output_file_name": "bar.json", "model_part_name": "Structure.Bar",
                    "output_variables": ["DISPLACEMENT", "VELOCITY"], "time_frequency": 0.0}}]}});
    write_json(&folder.path().join(DECK), &deck);
    folder
}

fn impact(method: &str, elements: usize, time_step: f64, springs: Value) -> Impact {
    let folder = write_impact(method, elements, time_step, 0.01, springs);
    let said = run(folder.path());
    let results = Results::read(&folder.path().join("bar.json")).expect("results");
    let step = results.step(None).expect("a step");
    let time = results.times()[step];
    let last = 2 * (elements + 3) - 2;
    let weight = |node: u64| if node <= 6 || node as usize > last { 0.25 } else { 0.5 } / elements as f64;
    let mean = |quantity: &str, power: i32| {
        results.nodal(quantity, step).iter().map(|(&node, v)| weight(node) * v.powi(power)).sum::<f64>()
    };
    let exact = -0.001 + 0.01 * (time - 0.1 - 2.0);
    Impact { displacement: mean("DISPLACEMENT_Y", 1) - exact, energy: mean("VELOCITY_Y", 2) / 1e-4, said }
}

/// Contact makes no energy in explicit steps up to the critical one of the bar, whatever the penalty asked for: it is lowered to a
/// value that is stable for the steps. One that is given stays, and is warned of.
#[test]
fn explicit_contact_makes_no_energy() {
    let h = 0.05;
    for share in [0.2, 0.4, 0.7, 0.9] {
        for factor in [1.0, 4.0, 10.0] {
            let found = impact("explicit", 20, share * h, json!({"stiffness_factor": factor}));
            println!("steps of {share} h/c, {factor} E/h: energy {:.4}", found.energy);
            assert!((found.energy - 1.0).abs() < 0.04, "steps of {share} h/c, {factor} E/h: {}", found.energy);
            assert_eq!(found.said.contains("contact-step"), share * share * (1.0 + factor) > 1.0, "{}", found.said);
        }
    }
    let given = impact("explicit", 20, 0.9 * h, json!({"manual_ALM": true, "penalty": 10.0 / h}));
    for code in ["warning[contact-step]", "warning[explicit-unstable]"] {
        assert!(given.said.contains(code), "no {code} in {}", given.said);
    }
}

/// A bar that hits the wall at 0.6 of its wave speed goes 0.3 of a cell into it, where contact of explicit steps is no more than the largest
/// stable penalty: the run ends there, and says how it can be mended. A setting allows it.
#[test]
fn explicit_steps_that_pierce_are_refused() {
    for process in ["explicit_penalty_contact_process", "penalty_contact_process"] {
        let folder = write_impact("explicit", 20, 0.02, 0.6, json!({}));
        let path = folder.path().join(DECK);
        let mut deck = read_json(&path).expect("the deck");
        deck["processes"]["contact_process_list"][0]["python_module"] = json!(process);
        write_json(&path, &deck);
        let output = zelus(folder.path(), &["run", DECK]);
        assert_eq!(output.status.code(), Some(3), "{process}: {}", said(&output));
        for words in
            ["inside the master by more than 0.2 of their mesh size", "shorten \"time_step\"", "largest_penetration"]
        {
            assert!(said(&output).contains(words), "{process}: no {words:?} in: {}", said(&output));
        }
        deck["solver_settings"]["contact_settings"]["largest_penetration"] = json!(0.0);
        write_json(&path, &deck);
        run(folder.path());
    }
}

/// The bar touches the wall for the time 2 L/c that a wave needs to its end and back, and leaves with the speed it came
/// with.
#[test]
fn a_bar_rebounds_in_explicit_and_implicit_steps() {
    for method in ["explicit", "implicit"] {
        let found = [20, 40, 80].map(|n| impact(method, n, 0.4 / n as f64, json!({})));
        let said: Vec<String> =
            found.iter().map(|i| format!("off by {:.2e}, energy {:.4}", i.displacement, i.energy)).collect();
        println!("{method}: {}", said.join("; "));
        let error = |i: &Impact| i.displacement.abs() / 0.004;
        assert!(
            error(&found[1]) < 0.7 * error(&found[0]) && error(&found[2]) < 0.7 * error(&found[1]),
            "{method}: {said:?}"
        );
        assert!(error(&found[2]) < 0.1, "{method}: {said:?}");
        let lost = |i: &Impact| (1.0 - i.energy).abs();
        assert!(lost(&found[2]) < 0.02 && lost(&found[2]) < lost(&found[0]).max(0.01), "{method}: {said:?}");
    }
}

/// Contact that always slides stands still under a load that grows: friction of either sign moved it the other way, for ever.
#[test]
fn pure_slip_stands_still() {
    let scratch = case("contact_2d/friction_pure_slip");
    let mut deck = read_json(&scratch.path().join(DECK)).expect("the deck");
    deck["problem_data"]["end_time"] = json!(2.0);
    // sliding until t = 0.4
    deck["processes"]["constraints_process_list"][1]["Parameters"]["value"][0] = json!("2.5e-6*(t+0.4-abs(t-0.4))");
    for load in deck["processes"]["loads_process_list"].as_array_mut().expect("loads") {
        if load["Parameters"]["model_part_name"] == "Structure.Top" {
            load["Parameters"]["modulus"] = json!("1000.0*(1.0+t)");
        }
    }
    write_json(&scratch.path().join(DECK), &deck);
    let said = run(scratch.path());
    assert!(said.contains("10 steps converged") && !said.contains("retried"), "{said}");
}
