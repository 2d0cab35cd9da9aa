//! A body that nothing holds is no result: in sweeps over blocks that contact alone may hold, every step that is accepted
//! balances its load, and a run that ends with 0 has accepted the last one.

use std::path::Path;

use serde_json::{Value, json};
use zelus::{RunOptions, Silent, Simulation};

use crate::blocks::{Deck, Joint, Mesh};
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

/// Without a gap, friction or curvature a shorter step is the same problem: cutting ends with the second attempt. Contact
/// stabilisation, whose length is that of the mesh, is off.
#[test]
fn steps_that_only_scale_are_cut_once() {
    let stack = Stack { divisions: [5, 7], formulation: SMOOTH, guided: false, ..PATCH };
    let folder = tempfile::tempdir().expect("a scratch folder");
    stack.write(folder.path(), |deck| deck["solver_settings"]["contact_stabilization"] = json!(false));
    let output = zelus(folder.path(), &["run", "ProjectParameters.json", "--report", "report.json", "--threads", "1"]);
    let report = read_json(&folder.path().join("report.json")).expect("the report");
    assert!(matches!(output.status.code(), Some(3 | 4)), "{}", said(&output));
    assert!(said(&output).contains("it is the same problem"), "{}", said(&output));
    assert_eq!(report["steps"].as_array().map(Vec::len), Some(2), "{}", said(&output));
    // Penalty and scale factor stand in the report and are printed once.
    let factor = report["parameters"]["scale factor k"].as_f64().expect("the scale factor");
    assert!(factor > stacks::YOUNG && said(&output).matches("scale factor k").count() == 1);
}

/// Size of the wedge that tilts: its width, the slope of its lower side, the load per length of its top.
const WIDTH: f64 = 1.0;
const SLOPE: f64 = 0.04;
const PRESSURE: f64 = 1.0;
/// Young's modulus by which strains are 1e-5.
const STIFF: f64 = 1e5;
/// Iterations of the step at most, where the block is close to the table.
const MOST: usize = 10;
/// Iterations at most where it falls by six facets.
const MOST_OF_FALL: usize = 30;

/// A block whose lower side rises by [`SLOPE`] to the right, above a table.
#[derive(Debug, Clone, Copy)]
struct Wedge {
    /// Cells along the sides of block and table.
    cells: [usize; 2],
    quadratic: bool,
    triangles: bool,
    gap: f64,
    /// Young's modulus, so large that the block hardly deforms.
    young: f64,
}

impl Wedge {
    /// Writes its deck; gives the nodes of its lower side.
    fn write(&self, folder: &Path) -> Vec<usize> {
        let mut mesh = Mesh::new(2);
        mesh.cut_cells(self.triangles);
        let table =
            mesh.block("Lower", [self.cells[1], 3, 1], |[x, y, _]| [1.5 * WIDTH * (x - 0.5), 0.4 * (y - 1.0), 0.0]);
        let lower_side = |x: f64| self.gap + SLOPE * WIDTH * x;
        let block = mesh.block("Upper", [self.cells[0], 4, 1], |[x, y, _]| {
            [WIDTH * (x - 0.5), lower_side(x) * (1.0 - y) + (0.5 + self.gap) * y, 0.0]
        });
        let (own, other) = (&block[&(1, 0)], &table[&(1, 1)]);
        mesh.part("Slave", own.0.clone(), own.1.clone());
        mesh.part("Interface", [own.0.clone(), other.0.clone()].concat(), [own.1.clone(), other.1.clone()].concat());
        mesh.part("Top", block[&(1, 1)].0.clone(), block[&(1, 1)].1.clone());
        mesh.part("Guide", [block[&(1, 1)].0[self.cells[0] / 2]], Vec::new());
        mesh.part("Base", table[&(1, 0)].0.clone(), Vec::new());
        if self.quadratic {
            mesh.raise("Upper", false);
            mesh.raise("Lower", false);
        }
        let still = [json!(0.0), json!(0.0), Value::Null];
        let guided = [json!(0.0), Value::Null, Value::Null];
        let supports = vec![("Base".to_owned(), still), ("Guide".to_owned(), guided)];
        let nodes = own.0.clone();
        let deck = Deck { mesh, joint: Joint::Frictionless, supports, pressure: PRESSURE, young: self.young, steps: 1 };
        deck.write(folder, |deck| {
            deck["solver_settings"]["contact_settings"] = json!({"mortar_type": "ALMContactFrictionless"});
            deck["solver_settings"]["residual_relative_tolerance"] = json!(1e-6);
            deck["processes"]["json_output_process_list"] = json!([]);
        });
        nodes
    }

    /// Runs it and compares with the closed form; gives the iterations of each attempt at its step.
    fn must_lie_flat(&self) -> Vec<usize> {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let nodes = self.write(folder.path());
        let mut run = Simulation::open(&folder.path().join("ProjectParameters.json"), &RunOptions::default())
            .unwrap_or_else(|error| panic!("{self:?}: {error}"));
        run.run(&mut Silent).unwrap_or_else(|error| panic!("{self:?}: {error}"));
        let displacement = run.field("DISPLACEMENT").expect("displacements");
        let reaction = run.field("REACTION").expect("reactions");
        let part = run.part().expect("a part");
        for &node in &nodes {
            let (x, u) = (part.nodes.initial[node - 1], displacement[3 * (node - 1) + 1]);
            assert!((u + x[1]).abs() < 2e-5, "{self:?}: node {node} at {x:?} has moved by {u}, {} is right", -x[1]);
        }
        let lifted: f64 = reaction.iter().skip(1).step_by(3).sum();
        assert!((lifted / (PRESSURE * WIDTH) - 1.0).abs() < 1e-5, "{self:?}: the table carries {lifted}");
        run.report().steps.iter().map(|step| step.iterations.len()).collect()
    }
}

/// ANALYTIC. A block that one corner touches, or nothing, tilts under its load until it lies flat: its lower side moves by minus its
/// height above the table, up to its strains, and the table carries the load. The first tangent is singular.
#[test]
fn a_wedge_tilts_until_it_lies_flat() {
    for (cells, quadratic, triangles) in [([6, 7], false, false), ([12, 15], false, true), ([5, 6], true, false)] {
        for gap in [0.0, 1e-6, 0.01] {
            let wedge = Wedge { cells, quadratic, triangles, gap, young: STIFF };
            let attempts = wedge.must_lie_flat();
            println!("{wedge:?}: {attempts:?} iterations");
            assert!(attempts.len() == 1 && attempts[0] <= MOST, "{wedge:?}: {attempts:?} iterations");
        }
    }
}

/// ANALYTIC. A block above the table by more than the search radius falls on it, however stiff it is for its load: pairs are searched
/// for on its way.
#[test]
fn a_wedge_far_above_the_table_falls_on_it() {
    for young in [STIFF, 1e9] {
        let wedge = Wedge { cells: [6, 7], quadratic: false, triangles: false, gap: 1.0, young };
        let attempts = wedge.must_lie_flat();
        println!("{wedge:?}: {attempts:?} iterations");
        assert!(attempts.len() == 1 && attempts[0] <= MOST_OF_FALL, "{wedge:?}: {attempts:?} iterations");
    }
}
