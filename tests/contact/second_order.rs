//! Contact and ties of elements of second order, with each other and with those of first order: a uniform pressure is
//! transmitted exactly (ANALYTIC), whatever the shapes.

use std::collections::BTreeMap;
use std::path::Path;

use crate::blocks::{Deck, Joint, Mesh, POISSON, Vec3};
use crate::thread_ranks::on_threads;
use serde_json::{Value, json};
use zelus::core::communication::Ranks;
use zelus::{RunOptions, Silent, Simulation};

/// Kind of the elements of a block: whether simplices, and whether of second order, with nodes in the middle of faces or not.
pub type Kind = (bool, Option<bool>);

const LINEAR: Option<bool> = None;
const SERENDIPITY: Option<bool> = Some(false);
const FULL: Option<bool> = Some(true);

/// Two blocks of unlike meshes one on the other, the upper one pressed down.
pub fn stack(space: usize, kinds: [Kind; 2], upper_is_slave: bool) -> Mesh {
    stack_of_cells(space, kinds, upper_is_slave, 1)
}

/// The same with so many times the cells along each edge.
fn stack_of_cells(space: usize, kinds: [Kind; 2], upper_is_slave: bool, times: usize) -> Mesh {
    let last = space - 1;
    let mut mesh = Mesh::new(space);
    let mut block = |name: &str, (simplices, _): Kind, divisions: [usize; 3], from: f64, skew: f64| {
        mesh.cut_cells(simplices);
        mesh.block(name, divisions.map(|cells| cells * times), |mut x| {
            // Cells of unlike lengths, which stay parallelograms.
            x[0] += skew * x[0] * (1.0 - x[0]);
            x[last] = from + 0.5 * x[last];
            x
        })
    };
    let lower = block("Lower", kinds[0], [2, 2, 1], 0.0, 0.0);
    let upper = block("Upper", kinds[1], if space == 2 { [3, 1, 1] } else { [3, 2, 1] }, 0.5, 0.2);
    let (low, up) = (&lower[&(last, 1)], &upper[&(last, 0)]);
    let slave = if upper_is_slave { up } else { low };
    mesh.part("Slave", slave.0.clone(), slave.1.clone());
    mesh.part("Interface", [low.0.clone(), up.0.clone()].concat(), [low.1.clone(), up.1.clone()].concat());
    mesh.part("Bottom", lower[&(last, 0)].0.clone(), Vec::new());
    mesh.part("Top", upper[&(last, 1)].0.clone(), upper[&(last, 1)].1.clone());
    for (axis, name) in ["PlaneX", "PlaneY"].into_iter().enumerate().take(last) {
        mesh.part(name, [lower[&(axis, 0)].0.clone(), upper[&(axis, 0)].0.clone()].concat(), Vec::new());
    }
    for (name, (_, order)) in ["Lower", "Upper"].into_iter().zip(kinds) {
        order.into_iter().for_each(|full| mesh.raise(name, full));
    }
    mesh
}

/// Runs the stack under a pressure of 1; gives the largest error of displacements relative to the largest of them, and the
/// least and the largest pressure of the slave nodes.
fn patch(space: usize, kinds: [Kind; 2], joint: Joint, change: impl FnOnce(&mut Value)) -> Result<[f64; 3], String> {
    // So stiff that the load, which acts on the deformed face, is that of the initial one.
    let young = 1e11;
    let mesh = stack(space, kinds, true);
    let holds = |axis: usize| std::array::from_fn(|c| if c == axis { json!(0.0) } else { Value::Null });
    let mut supports = vec![("Bottom".to_owned(), holds(space - 1))];
    supports.extend(["PlaneX", "PlaneY"].iter().enumerate().take(space - 1).map(|(c, n)| (n.to_string(), holds(c))));
    let deck = Deck { mesh, joint, supports, pressure: 1.0, young, steps: 1 };
    let folder = tempfile::tempdir().expect("a folder");
    deck.write(folder.path(), change);
    let options = RunOptions::default();
    let mut run =
        Simulation::open(&folder.path().join("ProjectParameters.json"), &options).map_err(|error| error.to_string())?;
    run.run(&mut Silent).map_err(|error| error.to_string())?;
    let part = run.part().expect("a part");
    let strain = 1.0 / young;
    let exact = |[x, y, z]: Vec3| match space {
        2 => [POISSON * (1.0 + POISSON) * strain * x, -(1.0 - POISSON * POISSON) * strain * y, 0.0],
        _ => [POISSON * strain * x, POISSON * strain * y, -strain * z],
    };
    let found = run.field("DISPLACEMENT").expect("displacements");
    let off = |(u, x): (&[f64], &Vec3)| {
        let exact = exact(*x);
        (0..3).map(|c| (u[c] - exact[c]).abs()).fold(0.0, f64::max)
    };
    let error = found.chunks(3).zip(&part.nodes.initial).map(off).fold(0.0, f64::max) / strain;
    // Multipliers of ties have a scale of their own.
    let scale = run.report().parameters.get("scale factor k").copied();
    let multipliers: Vec<f64> = match joint {
        Joint::Frictionless => run.field("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE").expect("multipliers").to_vec(),
        _ => {
            let all = run.field("VECTOR_LAGRANGE_MULTIPLIER").expect("multipliers");
            all.chunks(3).map(|lambda| lambda[space - 1].abs()).collect()
        }
    };
    let slave = part.part("Slave").expect("the slave").nodes.clone();
    let scale = scale.unwrap_or(multipliers[slave[0] as usize].recip());
    let pressures = slave.iter().map(|&node| scale * multipliers[node as usize].abs());
    let [least, most] = pressures.fold([f64::MAX, 0.0_f64], |[least, most], p| [least.min(p), most.max(p)]);
    Ok([error, least, most])
}

/// Every pair of kinds in a space.
fn pairs(space: usize) -> Vec<[Kind; 2]> {
    let kinds: Vec<Kind> = match space {
        2 => vec![(false, LINEAR), (true, SERENDIPITY), (false, SERENDIPITY), (false, FULL)],
        _ => vec![(true, LINEAR), (false, LINEAR), (true, SERENDIPITY), (false, SERENDIPITY), (false, FULL)],
    };
    let all = kinds.iter().flat_map(|&a| kinds.iter().map(move |&b| [a, b]));
    let is_curved = |pair: &[Kind; 2]| pair.iter().any(|(_, order)| order.is_some());
    all.filter(is_curved).collect()
}

#[test]
fn a_uniform_pressure_is_transmitted_exactly() {
    let mut problems = Vec::new();
    for space in [2, 3] {
        for kinds in pairs(space) {
            for joint in [Joint::Frictionless, Joint::Frictional(0.3), Joint::Tied] {
                match patch(space, kinds, joint, |_| {}) {
                    Ok([error, least, most]) => {
                        let pressures = (least - 1.0).abs().max((most - 1.0).abs());
                        println!("{space}D {kinds:?} {joint:?}: {error:.1e}, pressure {pressures:.1e}");
                        if !(error < 1e-10 && pressures < 1e-10) {
                            problems.push(format!("{space}D {kinds:?} {joint:?}: {error:e}, {least} to {most}"));
                        }
                    }
                    Err(said) => problems.push(format!("{space}D {kinds:?} {joint:?}: {said}")),
                }
            }
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

/// Displacements of the nodes by id and the iterations of each solve, on one of the ranks that share the run.
fn solved(folder: &Path, ranks: Ranks) -> (BTreeMap<usize, Vec3>, Vec<usize>) {
    let options = RunOptions { threads: Some(1), ranks, ..RunOptions::default() };
    let mut run = Simulation::open(&folder.join("ProjectParameters.json"), &options).expect("a deck");
    run.run(&mut Silent).expect("a result");
    let found = run.field("DISPLACEMENT").expect("displacements").chunks_exact(3);
    let displacements =
        run.part().expect("a part").nodes.ids.iter().zip(found).map(|(&id, u)| (id, [u[0], u[1], u[2]]));
    let iterations = run.report().steps.iter().flat_map(|step| &step.iterations);
    (displacements.collect(), iterations.map(|iteration| iteration.linear_iterations).collect())
}

/// Multigrid takes the linear cells of the corners for its first coarse space, with multipliers and over ranks. ANALYTIC: the answer is
/// that of the direct solver, to the 1e-8 to which both solve. REGRESSION: at most 80 iterations for eleven digits, of which 50 to 70 were
/// measured.
#[test]
fn multigrid_goes_from_second_order_cells_to_their_corners() {
    let kinds = [((true, SERENDIPITY), 3), ((false, SERENDIPITY), 3), ((false, FULL), 2)];
    for ((kind, times), joint) in kinds.into_iter().zip([Joint::Frictionless, Joint::Frictional(0.3), Joint::Tied]) {
        let hold = |part: &str, axes: std::ops::Range<usize>| {
            (part.to_owned(), std::array::from_fn(|c| if axes.contains(&c) { json!(0.0) } else { Value::Null }))
        };
        // The bottom cannot widen, so that stresses vary.
        let supports = vec![hold("Bottom", 0..3), hold("PlaneX", 0..1), hold("PlaneY", 1..2)];
        let mesh = stack_of_cells(3, [kind; 2], true, times);
        let deck = Deck { mesh, joint, supports, pressure: 1e7, young: 1e11, steps: 1 };
        let by = |solver: Value| {
            let folder = tempfile::tempdir().expect("a folder");
            deck.write(folder.path(), |deck| deck["solver_settings"]["linear_solver_settings"] = solver);
            folder
        };
        let (exact, _) = solved(by(json!({"solver_type": "sparse_lu"})).path(), Ranks::default());
        let size = exact.values().flatten().fold(0.0_f64, |most, u| most.max(u.abs()));
        let off = |found: &BTreeMap<usize, Vec3>| {
            let each = found.iter().flat_map(|(id, u)| u.iter().zip(exact[id]).map(|(a, b)| (a - b).abs()));
            each.fold(0.0, f64::max) / size
        };
        let folder = by(json!({"solver_type": "amgcl", "direct_below": 0, "tolerance": 1e-11}));
        let (alone, iterations) = solved(folder.path(), Ranks::default());
        println!("{kind:?} {joint:?}: {iterations:?} iterations, off by {:.1e}", off(&alone));
        assert!(off(&alone) < 1e-8 && iterations.iter().all(|&number| number <= 80), "{kind:?}: {iterations:?}");
        for (shared, iterations) in on_threads(2, |ranks| solved(folder.path(), ranks)) {
            println!("two ranks: {iterations:?} iterations, off by {:.1e}", off(&shared));
            assert!(off(&shared) < 1e-8 && iterations.iter().all(|&number| number <= 80), "{kind:?}: {iterations:?}");
        }
    }
}
