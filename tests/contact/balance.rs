//! The balance of accepted steps: closed forms of loads, reactions and remainder, on any number of ranks.

use crate::support;
use std::path::Path;

use crate::support::root;
use crate::thread_ranks::on_threads;
use serde_json::{Value, json};
use zelus::core::communication::Ranks;
use zelus::core::strategies::Balance;
use zelus::{RunOptions, Silent, Simulation};

fn deck(folder: &Path) -> Value {
    let mut deck = support::read_json(&folder.join("ProjectParameters.json")).expect("the deck");
    deck["processes"].as_object_mut().expect("lists").remove("json_output_process_list");
    deck
}

/// The balances of all steps of a case, which `change` alters.
fn balances(case: &str, ranks: Ranks, change: impl FnOnce(&mut Value)) -> Vec<Balance> {
    let folder = root().join("tests/cases").join(case);
    let mut deck = deck(&folder);
    change(&mut deck);
    let options = RunOptions { threads: Some(1), ranks, ..RunOptions::default() };
    let mut simulation = Simulation::of_value(&deck, &folder, &options).expect("a deck");
    simulation.run(&mut Silent).expect("it converges");
    let balance = |step: &zelus::core::strategies::StepRecord| step.balance.clone().expect("a balance");
    simulation.records().iter().map(balance).collect()
}

fn assert_near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance * expected.abs(), "{what}: {found:e}, not {expected:e}");
}

#[test]
fn a_pressed_block_hands_its_load_through_contact_to_the_ground() {
    for formulation in ["ALMContactFrictionless", "ALMContactFrictionlessComponents", "PenaltyContactFrictionless"] {
        let of = balances("contact_2d/matching", Ranks::default(), |deck| {
            deck["solver_settings"]["contact_settings"]["mortar_type"] = json!(formulation);
            let process = &mut deck["processes"]["contact_process_list"][0];
            match formulation {
                "ALMContactFrictionlessComponents" => {
                    process["Parameters"]["contact_type"] = json!("FrictionlessComponents");
                }
                "PenaltyContactFrictionless" => process["python_module"] = json!("penalty_contact_process"),
                _ => {}
            }
        });
        let [balance] = &of[..] else { panic!("one step") };
        let forces = balance.unknowns[0].forces;
        assert_near(forces.loads[1], -1e6, 1e-10, "load");
        assert_near(forces.reactions[1], 1e6, 1e-10, "reaction");
        let [pair] = &balance.pairs[..] else { panic!("one pair") };
        assert_near(pair.force[1].abs(), 1e6, 1e-10, "contact");
        assert!(forces.relative < 1e-10 && pair.out_of_balance[1].abs() < 1e-4, "{formulation}: {balance:?}");
        assert!(forces.elements[1].abs() < 1e-4 && forces.inertia == [0.0; 3]);
        assert_eq!((pair.open, pair.sticking, pair.name.as_str()), (0, 0, "0: Slave on Interface"));
        assert_eq!(pair.slipping, 4);
        let depth = if formulation.starts_with("Penalty") { 1e-9..1e-2 } else { -1e-12..1e-9 };
        assert!(depth.contains(&pair.penetration) && pair.dissipated == 0.0, "{formulation}: {}", pair.penetration);
        let energies = balance.energies;
        assert_near(energies.loads, energies.stored - energies.interactions, 1e-9, "energies");
        assert!(energies.stored > 0.0 && energies.supports.abs() < 1e-9 * energies.stored);
        let moments = balance.unknowns[0].moments.expect("displacements move nodes");
        assert!(moments.out_of_balance[2].abs() < 1e-4);
    }
}

#[test]
fn friction_dissipates_its_bound_times_the_slip() {
    let of = balances("contact_2d/friction_slide", Ranks::default(), |_| {});
    let last: Vec<&Balance> = of.iter().rev().take(2).collect();
    // Both steps slide as a whole, so that the top moves as the interface does.
    for balance in &last {
        assert_eq!((balance.pairs[0].open, balance.pairs[0].sticking), (0, 0));
        assert_near(balance.pairs[0].force[0].abs(), 300.0, 1e-7, "friction");
        assert!(balance.unknowns[0].forces.relative < 1e-10);
    }
    let [now, before] = [0, 1].map(|at| last[at].energies);
    // The slip of nodes is integrated over overlaps, which change with it.
    assert_near(now.dissipated - before.dissipated, 300.0 * 5e-6 * 0.2, 1e-5, "heat");
    assert_near(now.supports - before.supports, 300.0 * 5e-6 * 0.2, 1e-7, "work of the support");
    assert_eq!(now.dissipated, last[0].pairs[0].dissipated);
}

#[test]
fn what_falls_freely_turns_its_weight_into_motion() {
    let of = balances("structural/self_weight", Ranks::default(), |deck| {
        let solver = deck["solver_settings"].as_object_mut().expect("settings");
        let mut more =
            json!({"solver_type": "Dynamic", "time_integration_method": "implicit", "scheme_type": "newmark"});
        solver.append(more.as_object_mut().expect("settings"));
        solver.insert("time_stepping".to_owned(), json!({"time_step": 0.25}));
        deck["problem_data"]["end_time"] = json!(1.0);
        deck["processes"]["constraints_process_list"] = json!([]);
    });
    assert_eq!(of.len(), 4);
    let weight = of[0].unknowns[0].forces.loads;
    for balance in &of {
        let forces = balance.unknowns[0].forces;
        assert_eq!(forces.reactions, [0.0; 3]);
        let left = (0..3).map(|c| (forces.inertia[c] + weight[c]).abs()).fold(0.0, f64::max);
        assert!(left < 1e-8 * weight[2].abs(), "{forces:?}");
        assert_near(balance.energies.loads, balance.energies.kinetic, 1e-9, "energies");
        assert!(balance.energies.stored.abs() < 1e-9 * balance.energies.kinetic);
    }
    // By Newmark's method the weight comes up within the first step: m g² (t − Δt/2)²/2.
    assert_near(of[3].energies.kinetic, 0.5 * weight[2].abs() * 10.0 * 0.875_f64.powi(2), 1e-9, "kinetic energy");
}

/// The energies of explicit steps do not depend on the number of ranks; REGRESSION: round-off, 1e-9 of the largest.
#[test]
fn energies_of_explicit_steps_are_the_same_on_any_number_of_ranks() {
    let longer = |deck: &mut Value| deck["problem_data"]["end_time"] = json!(4e-5);
    let alone = balances("contact_3d/explicit_touch", Ranks::default(), longer);
    assert!(alone.iter().any(|balance| balance.energies.penalty > 0.0), "no contact");
    for of_rank in on_threads(3, |ranks| balances("contact_3d/explicit_touch", ranks, longer)) {
        is_same(&of_rank, &alone).unwrap_or_else(|what| panic!("{what}"));
    }
}

#[test]
fn sums_and_counts_are_the_same_on_any_number_of_ranks() {
    for case in ["contact_2d/friction_arc", "contact_3d/hexahedra_nonmatching", "mpc/pressed_and_opened_hexahedra"] {
        let alone = balances(case, Ranks::default(), |_| {});
        for of_rank in on_threads(3, |ranks| balances(case, ranks, |_| {})) {
            is_same(&of_rank, &alone).unwrap_or_else(|what| panic!("{case}: {what}"));
        }
    }
}

/// Numbers within 1e-9 of the largest of their kind in the run, words and counts the same.
fn is_same(found: &[Balance], expected: &[Balance]) -> Result<(), String> {
    let [found, expected] = [found, expected].map(|of| serde_json::to_value(of).expect("JSON"));
    ["unknowns", "pairs", "energies"].iter().try_for_each(|key| {
        let of_key = |run: &Value| run.as_array().expect("steps").iter().map(|step| step[key].clone()).collect();
        let [found, expected]: [Value; 2] = [&found, &expected].map(of_key);
        // Where supports push against each other, sums are round-off of their forces.
        let scale = largest(&expected).max(if *key == "unknowns" { 1e2 } else { 0.0 });
        compare(key, &found, &expected, scale)
    })
}

fn compare(name: &str, found: &Value, expected: &Value, scale: f64) -> Result<(), String> {
    match (found, expected) {
        (Value::Object(found), Value::Object(expected)) => {
            // The relative remainder is a share of round-off.
            let mut keys = expected.iter().filter(|(key, _)| *key != "relative");
            keys.try_for_each(|(key, value)| compare(&format!("{name}.{key}"), &found[key], value, scale))
        }
        (Value::Array(found), Value::Array(expected)) if found.len() == expected.len() => {
            found.iter().zip(expected).try_for_each(|(found, expected)| compare(name, found, expected, scale))
        }
        (Value::Number(a), Value::Number(b)) if !(a.is_u64() && b.is_u64()) => {
            let [a, b] = [a, b].map(|number| number.as_f64().expect("a number"));
            if (a - b).abs() <= 1e-9 * scale { Ok(()) } else { Err(format!("{name} is {a:e}, not {b:e}")) }
        }
        _ if found == expected => Ok(()),
        _ => Err(format!("{name} is {found}, not {expected}")),
    }
}

fn largest(value: &Value) -> f64 {
    match value {
        Value::Array(list) => list.iter().map(largest).fold(0.0, f64::max),
        Value::Object(of) => of.values().map(largest).fold(0.0, f64::max),
        Value::Number(number) => number.as_f64().expect("a number").abs(),
        _ => 0.0,
    }
}

/// Supports that pull against each other alone add up to nothing, and the remainder is small beside the pull of each.
#[test]
fn supports_that_pull_alone_are_in_balance() {
    for case in ["elements/displacement_patch_2D4N", "elements/displacement_patch_3D8N"] {
        for balance in balances(case, Ranks::default(), |_| {}) {
            let of = &balance.unknowns[0];
            let relative = [of.forces.relative, of.moments.expect("moments").relative];
            assert!(relative.iter().all(|relative| *relative < 1e-9), "{case}: {of:?}");
        }
    }
}
