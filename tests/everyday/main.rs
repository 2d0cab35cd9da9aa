//! Everyday problems of contact, each without friction and with, run with default settings as a first attempt would.
//!
//! Every accepted step must be in balance and fulfil the conditions of contact and friction, and integrate all facets opposite the
//! master; besides, each problem has a number that theory or symmetry gives.
//!
//! `ZELUS_EVERYDAY=FOLDER` in the environment keeps the decks there.

#[path = "../bulk/grid.rs"]
#[allow(dead_code, reason = "both use their part of it")]
mod grid;
mod model;
mod outcome;
mod problems;
#[path = "../support/mod.rs"]
mod support;

use std::f64::consts::FRAC_PI_2;

use model::{Look, PLAIN};
use outcome::{Outcome, norm};
use problems::{ALL, Punch, ball, punch};

/// Problems that are solved in several positions.
const STEADY: [&str; 10] = [
    "press_fit",
    "lug_with_pin",
    "gear_pair",
    "stack_of_four",
    "tilted_landing",
    "wedge",
    "initial_gap",
    "initial_penetration",
    "flat_punch",
    "quarter_lug",
];

/// Coefficient of friction of those that have it.
const FRICTION: f64 = 0.2;

/// Difference of displacements and multipliers, as a share of their largest, that the default tolerances leave.
const SAME: f64 = 5e-3;

/// The answer to a problem with its faults.
fn answer(name: &str, friction: Option<f64>, look: Look, more: usize) -> Result<Outcome, Vec<String>> {
    let (_, make, steps) = ALL.into_iter().find(|(known, ..)| *known == name).expect("a problem of this name");
    let mut problem = make(friction, steps * more, 1);
    problem.model.look = look;
    let kind = if friction.is_some() { "_friction" } else { "" };
    let method = if look.penalty { "_penalty" } else { "" };
    let (turn, steps) = (look.turn.to_degrees(), problem.model.steps);
    let place = format!("{name}{kind}{method}_{turn:.0}_{}_{}_{steps}", look.size, look.backwards);
    let outcome = problem.model.run(&place).map_err(|said| vec![said])?;
    println!("{place}: {} steps, {} iterations", outcome.states.len(), outcome.iterations);
    let mut faults = outcome.faults(&problem.model, problem.load);
    faults.extend((problem.check)(&problem.model, &outcome));
    match faults.is_empty() {
        true => Ok(outcome),
        false => Err(faults.into_iter().map(|fault| format!("{place}: {fault}")).collect()),
    }
}

fn runs(name: &str) {
    let faults: Vec<String> = [None, Some(FRICTION)]
        .into_iter()
        .filter_map(|friction| answer(name, friction, PLAIN, 1).err())
        .flatten()
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The end of a run of another look or with more steps is that of the plain one.
fn same(name: &str, friction: Option<f64>, look: Look, more: usize) -> Vec<String> {
    let plain = match answer(name, friction, PLAIN, 1) {
        Ok(plain) => plain,
        Err(faults) => return faults,
    };
    let other = match answer(name, friction, look, more) {
        Ok(other) => other,
        Err(faults) => return faults,
    };
    let fields = |outcome: &Outcome| {
        // a multiplier counts in a unit of its own
        let multipliers = &outcome.last().multiplier;
        let largest = multipliers.iter().map(|&v| norm(v)).fold(0.0, f64::max);
        [outcome.last().displacement.clone(), multipliers.iter().map(|v| v.map(|x| x / largest)).collect()]
    };
    let compared = fields(&plain).into_iter().zip(fields(&other)).zip(["displacements", "multipliers"]);
    let differences = compared.filter_map(|((one, other), what)| {
        let largest = one.iter().map(|&v| norm(v)).fold(0.0, f64::max);
        let off = one.iter().zip(&other).map(|(a, b)| norm(std::array::from_fn(|c| a[c] - b[c]))).fold(0.0, f64::max);
        (off.is_nan() || off > SAME * largest)
            .then(|| format!("{name}: {what} differ by {:.1e} of the largest", off / largest))
    });
    differences.collect()
}

fn none(faults: impl Iterator<Item = Vec<String>>) {
    let faults: Vec<String> = faults.flatten().collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Without friction elastic contact does not depend on the way: twice as many steps end alike.
#[test]
fn steps_change_nothing_without_friction() {
    none(STEADY.into_iter().map(|name| same(name, None, PLAIN, 2)));
}

/// A penalty ends like multipliers.
#[test]
fn penalties_change_nothing() {
    let look = Look { penalty: true, ..PLAIN };
    let cases = STEADY.into_iter().flat_map(|name| [None, Some(FRICTION)].map(|friction| (name, friction)));
    none(cases.map(|(name, friction)| same(name, friction, look, 1)));
}

/// Turned problems end alike: by any angle where supports hold all components, else by a right one.
#[test]
fn turns_change_nothing() {
    let free = ["lug_with_pin", "gear_pair", "tilted_landing", "flat_punch"];
    let look = |name: &str| Look { turn: if free.contains(&name) { 0.7 } else { FRAC_PI_2 }, ..PLAIN };
    none(STEADY.into_iter().map(|name| same(name, Some(FRICTION), look(name), 1)));
}

/// Problems numbered backwards and in micrometres or metres end alike.
#[test]
fn numbers_and_sizes_change_nothing() {
    let look = |at: usize| Look { size: [1e3, 1e-3][at % 2], backwards: true, ..PLAIN };
    none(STEADY.into_iter().enumerate().map(|(at, name)| same(name, Some(FRICTION), look(at), 1)));
}

macro_rules! problems {
    ($($name:ident)*) => {
        $(#[test]
        fn $name() {
            runs(stringify!($name));
        })*
    };
}

problems! {
    press_fit lug_with_pin gear_pair stack_of_four tilted_landing wedge initial_gap initial_penetration large_sliding
    snap_fit ring_between_plates ball_in_socket strip_round_a_drum flat_punch quarter_lug tubes sharp_snap_fit
    beam_over_an_edge ball_on_block
}

/// A slave node that next to nothing of its facets faces is in no contact: multipliers of 1e16 held such nodes, beside which all
/// others seemed to have none, and a state with the punch in the base was accepted without contact.
#[test]
fn surfaces_end_within_facets() {
    let mut faults = Vec::new();
    let turned = Look { turn: 0.6, about: [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0], ..PLAIN };
    for friction in [None, Some(0.0), Some(0.2), Some(1.0)] {
        for (dim, columns, off) in [
            (2, [6, 4], 0.0),
            (2, [9, 4], 0.0),
            (2, [12, 5], 0.003),
            (3, [6, 4], 0.0),
            (3, [7, 3], 0.0),
            (3, [6, 4], 0.01),
        ] {
            for (simplices, base_is_slave, look) in
                [(false, true, PLAIN), (false, false, PLAIN), (true, true, PLAIN), (false, true, turned)]
            {
                let look = if dim == 2 { Look { about: PLAIN.about, ..look } } else { look };
                let mut problem = punch(friction, 2, Punch { dim, simplices, columns, off, base_is_slave });
                problem.model.look = look;
                let place =
                    format!("punch_{friction:?}_{dim}_{columns:?}_{off}_{simplices}_{base_is_slave}_{}", look.turn);
                match problem.model.run(&place) {
                    Err(said) => faults.push(said),
                    Ok(outcome) => {
                        let found = outcome.faults(&problem.model, problem.load);
                        let found = found.into_iter().chain((problem.check)(&problem.model, &outcome));
                        faults.extend(found.map(|fault| format!("{place}: {fault}")));
                    }
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Contact over a billionth of its size at the origin is resolved as well as that around it: gaps of nodes there stalled.
#[test]
fn light_touches_end() {
    let mut faults = Vec::new();
    for friction in [None, Some(FRICTION)] {
        for (columns, depth) in [([6, 7], 1e-7), ([6, 6], 1e-9), ([8, 10], 1e-8)] {
            let problem = ball(friction, 3, columns, depth, true);
            match problem.model.run(&format!("touch_{friction:?}_{columns:?}_{depth:e}")) {
                Err(said) => faults.push(said),
                Ok(outcome) if outcome.last().touching(&problem.model).is_empty() => {
                    faults.push(format!("{columns:?} {depth:e}: no contact"));
                }
                Ok(outcome) => faults.extend(outcome.faults(&problem.model, problem.load)),
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
