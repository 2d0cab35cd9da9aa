//! A body that nothing holds is no result: in sweeps over blocks that contact alone may hold, every step that is accepted
//! balances its load, and a run that ends with 0 has accepted the last one.

use crate::stacks;
use crate::stacks::Stack;
use crate::support::{Results, read_json, said, zelus};

const ALM: (&str, &str) = ("ALMContactFrictional", "alm_contact_process");
const SMOOTH: (&str, &str) = ("ALMContactFrictionless", "alm_contact_process");
const PENALTY: (&str, &str) = ("PenaltyContactFrictionless", "penalty_contact_process");

const PATCH: Stack = Stack {
    space: 2,
    divisions: [9, 10],
    tilt: 20.0,
    gap: 0.0,
    turn: 0.0,
    axis: [0.0, -1.0, 0.0],
    size: 1.0,
    guided: true,
    formulation: ALM,
    friction: 0.3,
    load: 1e-3,
};

/// Forces that supports may lack, as a share of the load.
const BALANCE: f64 = 1e-2;

/// Runs a deck: whether it ended with 0, and the faults of its accepted states.
fn run(stack: &Stack) -> (bool, Option<String>) {
    let folder = tempfile::tempdir().expect("a scratch folder");
    stack.write(folder.path(), |_| {});
    let output = zelus(folder.path(), &["run", "ProjectParameters.json", "--threads", "1"]);
    let problem = |what: String| Some(format!("{stack:?}: {what}"));
    match output.status.code() {
        Some(0) => {}
        Some(3 | 4) if said(&output).contains("node") => {}
        code => return (false, problem(format!("exit code {code:?}: {}", said(&output)))),
    }
    let ended = output.status.success();
    let Ok(results) = Results::read(&folder.path().join("results.json")) else {
        return (ended, if ended { problem("no results".to_owned()) } else { None });
    };
    let total = |name: &str, step: usize| results.nodal(name, step).values().sum::<f64>();
    for (step, time) in results.times().iter().enumerate() {
        for (axis, down) in ["X", "Y", "Z"].into_iter().zip(stack.down()) {
            let lacking = (total(&format!("REACTION_{axis}"), step) + down * time * stack.force()).abs();
            // Guides carry the lateral force of the interface, and are among the supports.
            if lacking.is_nan() || lacking > BALANCE * time * stack.force() {
                return (
                    ended,
                    problem(format!("{:.1e} of the load is lost along {axis} at time {time}", lacking / stack.force())),
                );
            }
            let names = results.nodal(&format!("DISPLACEMENT_{axis}"), step);
            let farthest = names.values().fold(0.0_f64, |most, u| most.max(u.abs()));
            if farthest > 0.2 * stack.size {
                return (ended, problem(format!("a node has moved by {farthest:.1e} at time {time}")));
            }
        }
    }
    (ended, None)
}

/// Runs all; the number of those that end with 0.
fn sweep(stacks: &[Stack]) -> usize {
    let outcomes: Vec<(bool, Option<String>)> = stacks.iter().map(run).collect();
    let problems: Vec<&str> = outcomes.iter().filter_map(|(_, problem)| problem.as_deref()).collect();
    assert!(problems.is_empty(), "{}", problems.join("\n"));
    outcomes.iter().filter(|(ended, _)| *ended).count()
}

/// A frictional patch whose tilted interface ends on a support: a block that had lost contact was accepted, 7.7e11 away, its
/// residual ticked as round-off.
#[test]
fn tilted_patch_on_a_support() {
    let mut stacks = Vec::new();
    for divisions in [[9, 10], [15, 15], [6, 8], [10, 9], [12, 12], [8, 12]] {
        for friction in [0.3, 1.0] {
            for tilt in [20.0, -20.0] {
                stacks.push(Stack { divisions, friction, tilt, ..PATCH });
            }
        }
    }
    assert!(sweep(&stacks) > stacks.len() / 2);
}

#[test]
fn blocks_with_a_gap_in_the_plane() {
    let mut stacks = Vec::new();
    for formulation in [SMOOTH, ALM, PENALTY] {
        for gap in [0.0, 1e-6, 1e-3, 0.02] {
            for (turn, guided) in [(0.0, true), (0.0, false), (37.0, false)] {
                for tilt in [0.0, 20.0] {
                    stacks.push(Stack { divisions: [5, 7], formulation, gap, turn, guided, tilt, ..PATCH });
                }
            }
        }
    }
    assert!(sweep(&stacks) >= 8);
}

#[test]
fn blocks_with_a_gap_in_space() {
    let mut stacks = Vec::new();
    for formulation in [SMOOTH, ALM] {
        for gap in [0.0, 1e-3] {
            for (turn, guided) in [(0.0, true), (37.0, false)] {
                for tilt in [0.0, 20.0] {
                    stacks.push(Stack { space: 3, divisions: [3, 4], formulation, gap, turn, guided, tilt, ..PATCH });
                }
            }
        }
    }
    assert!(sweep(&stacks) >= 3);
}

/// Gaps that a load closes are as wide in any position: a stack with a result upright has one rotated, too.
#[test]
fn gaps_turned_about_odd_axes() {
    let (mut upright, mut turned) = (Vec::new(), Vec::new());
    for formulation in [SMOOTH, ALM, PENALTY] {
        for (divisions, gap, tilt) in
            [([2, 3], 1e-3, 0.0), ([3, 2], 1e-3, 20.0), ([3, 4], 0.0, -20.0), ([4, 3], 0.02, 0.0)]
        {
            let stack = Stack { space: 3, divisions, formulation, gap, tilt, guided: false, ..PATCH };
            upright.push(stack);
            for (axis, turn) in [([1.0, 1.0, 0.3], 40.0), ([0.2, -1.0, 0.7], 125.0), ([1.0, 0.0, 0.0], 90.0)] {
                turned.push(Stack { axis, turn, ..stack });
            }
        }
    }
    let (of_upright, of_turned) = (sweep(&upright), sweep(&turned));
    assert_eq!(3 * of_upright, of_turned);
    assert!(of_upright > 0);
}

/// Without a gap, friction or curvature a shorter step is the same problem: cutting ends with the second attempt.
#[test]
fn steps_that_only_scale_are_cut_once() {
    let stack = Stack { divisions: [5, 7], formulation: SMOOTH, guided: false, ..PATCH };
    let folder = tempfile::tempdir().expect("a scratch folder");
    stack.write(folder.path(), |_| {});
    let output = zelus(folder.path(), &["run", "ProjectParameters.json", "--report", "report.json", "--threads", "1"]);
    let report = read_json(&folder.path().join("report.json")).expect("the report");
    assert!(matches!(output.status.code(), Some(3 | 4)), "{}", said(&output));
    assert!(said(&output).contains("it is the same problem"), "{}", said(&output));
    assert_eq!(report["steps"].as_array().map(Vec::len), Some(2), "{}", said(&output));
    // Penalty and scale factor stand in the report and are printed once.
    let factor = report["parameters"]["scale factor k"].as_f64().expect("the scale factor");
    assert!(factor > stacks::YOUNG && said(&output).matches("scale factor k").count() == 1);
}
