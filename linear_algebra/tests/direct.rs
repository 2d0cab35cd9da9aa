//! The direct engine on elastic boxes, tied boxes and awkward matrices.

mod samples;

use samples::{Brick, contact, fix};
use zelus_linear_algebra::{
    Csr, DirectSettings, Engine, Layout, LinearSolver, SolveError, SolveReport, Symmetry, System, create,
};

fn right_hand_side(n: usize) -> Vec<f64> {
    (0..n).map(|i| ((i * 7919) % 1000) as f64 / 1000.0 - 0.5).collect()
}

fn clamped_box(cells: usize) -> (Csr, Layout) {
    let brick = Brick::of_cubes([cells; 3]);
    let mut triplets = Vec::new();
    brick.stiffness(0, 1.0, &mut triplets);
    fix(&mut triplets, brick.layer(0).into_iter().flat_map(|node| 3 * node..3 * node + 3), 1.0);
    (Csr::from_triplets(3 * brick.nodes(), &triplets), Layout::blocked(brick.nodes(), 3))
}

fn direct(interface_limit: usize) -> Box<dyn LinearSolver> {
    create(Engine::Direct(DirectSettings { interface_limit, ..Default::default() }))
}

/// Solves for the known answer `1, 2, 3, …` and gives the report and the largest error relative to it.
fn solve_known(solver: &mut dyn LinearSolver, system: &System<'_>) -> (SolveReport, f64) {
    let n = system.equations();
    let exact: Vec<f64> = (0..n).map(|i| 1.0 + (i % 17) as f64).collect();
    let mut rhs = vec![0.0; n];
    system.mul_vec(&exact, &mut rhs);
    let mut x = vec![0.0; n];
    let report = solver.solve(system, &rhs, &mut x).expect("a regular matrix");
    let error = x.iter().zip(&exact).map(|(x, e)| (x - e).abs()).fold(0.0, f64::max) / 17.0;
    (report, error)
}

#[test]
fn cholesky_of_an_elastic_box() {
    let (bulk, layout) = clamped_box(9);
    let (report, error) = solve_known(&mut *direct(9000), &System::bulk(&layout, &bulk, Symmetry::PositiveDefinite));
    assert_eq!((report.engine, report.fallback), ("cholesky", None));
    assert!(error < 1e-10 && report.relative_residual < 1e-12, "{error}");
}

#[test]
fn an_indefinite_matrix_falls_back_to_lu() {
    let (mut bulk, layout) = clamped_box(8);
    for i in 0..bulk.rows {
        bulk.add(i, i, -0.9);
    }
    let mut solver = direct(9000);
    let mut system = System::bulk(&layout, &bulk, Symmetry::Symmetric);
    let (report, error) = solve_known(&mut *solver, &system);
    assert_eq!((report.engine, report.fallback.is_some()), ("multifrontal_lu", true));
    assert!(error < 1e-7, "{error}");
    system.bulk_values += 1;
    assert_eq!(solve_known(&mut *solver, &system).0.fallback, None, "cholesky pauses after a failure");
}

#[test]
fn an_unsymmetric_bulk_is_solved() {
    let (mut bulk, layout) = clamped_box(8);
    for (at, value) in bulk.values.iter_mut().enumerate() {
        *value *= 1.0 + 1e-3 * (at % 13) as f64;
    }
    let (report, error) = solve_known(&mut *direct(9000), &System::bulk(&layout, &bulk, Symmetry::General));
    assert_eq!(report.engine, "multifrontal_lu");
    assert!(error < 1e-9, "{error}");
}

#[test]
fn a_floating_body_is_held_by_multipliers() {
    for (skew, inactive) in [(0.0, 1000), (0.0, 3), (0.2, 4)] {
        let sample = contact(7, skew, |at| at % inactive != 1);
        let system = System {
            coupling: Some(&sample.coupling),
            coupling_symmetric: skew == 0.0,
            shared: None,
            ..System::bulk(&sample.layout, &sample.bulk, Symmetry::PositiveDefinite)
        };
        let (report, error) = solve_known(&mut *direct(9000), &system);
        assert_eq!(report.engine, "cholesky+interface");
        assert!(error < 1e-7, "dense interface: {error}");
        let (report, error) = solve_known(&mut *direct(0), &system);
        assert_eq!(report.engine, "multifrontal_lu");
        assert!(error < 1e-7, "whole matrix: {error}");
        let (report, error) = solve_known(&mut *create(Engine::Lu), &system);
        assert_eq!(report.engine, "sparse_lu");
        assert!(error < 1e-7, "sparse LU: {error}");
    }
}

#[test]
fn equations_that_are_held_count_for_nothing() {
    let mut sample = contact(7, 0.2, |at| at % 4 != 1);
    let n = sample.bulk.rows;
    let is_tangential = |i: usize| !sample.layout.multiplier[i] && i % 3 != 2;
    sample.layout.inactive = (0..n).map(|i| is_tangential(i) && sample.layout.node[i] % 7 == 3).collect();
    let contact = System {
        coupling: Some(&sample.coupling),
        coupling_symmetric: false,
        ..System::bulk(&sample.layout, &sample.bulk, Symmetry::PositiveDefinite)
    };
    let (clamped, mut layout) = clamped_box(8);
    layout.inactive = (0..clamped.rows).map(|i| i % 5 == 0).collect();
    let alone = System::bulk(&layout, &clamped, Symmetry::PositiveDefinite);
    let general = System::bulk(&layout, &clamped, Symmetry::General);
    let cases = [
        (contact, 9000, "cholesky+interface"),
        (contact, 0, "multifrontal_lu"),
        (alone, 9000, "cholesky"),
        (general, 9000, "multifrontal_lu"),
    ];
    for (system, limit, engine) in cases {
        let inactive = &system.layout.inactive;
        let exact: Vec<f64> =
            inactive.iter().enumerate().map(|(i, &h)| if h { 0.0 } else { 1.0 + (i % 17) as f64 }).collect();
        let mut rhs = vec![0.0; exact.len()];
        system.mul_vec(&exact, &mut rhs);
        // Numbers at inactive rows are not used.
        rhs.iter_mut().zip(inactive).filter(|(_, is_inactive)| **is_inactive).for_each(|(b, _)| *b = 1e6);
        for mut solver in [direct(limit), single(limit)] {
            let mut x = vec![3.0; exact.len()];
            let report = solver.solve(&system, &rhs, &mut x).expect("regular without what is held");
            assert_eq!(report.engine, engine);
            let error = x.iter().zip(&exact).map(|(x, e)| (x - e).abs()).fold(0.0, f64::max) / 17.0;
            assert!(error < 1e-7, "{engine}: {error}");
            assert!(x.iter().zip(inactive).all(|(x, is_inactive)| !is_inactive || *x == 0.0), "{engine}");
        }
    }
}

/// The engine with all factors in single precision.
fn single(interface_limit: usize) -> Box<dyn LinearSolver> {
    create(Engine::Direct(DirectSettings { interface_limit, single_from: 0, ..Default::default() }))
}

#[test]
fn factors_in_single_precision_give_answers_in_double() {
    let (bulk, layout) = clamped_box(9);
    for (symmetry, engine) in [(Symmetry::PositiveDefinite, "cholesky"), (Symmetry::General, "multifrontal_lu")] {
        // Stiffness far from one, which single precision alone could not hold.
        for unit in [1.0, 1e60, 1e-60] {
            let mut scaled = bulk.clone();
            scaled.values.iter_mut().for_each(|value| *value *= unit);
            let (report, error) = solve_known(&mut *single(9000), &System::bulk(&layout, &scaled, symmetry));
            assert_eq!((report.engine, report.fallback), (engine, None));
            assert!(report.iterations > 0, "one solve in single precision leaves seven digits");
            assert!(error < 1e-10 && report.relative_residual < 1e-12, "{engine} {unit}: {error}");
        }
    }
    let sample = contact(7, 0.2, |at| at % 4 != 1);
    let system = System {
        coupling: Some(&sample.coupling),
        coupling_symmetric: false,
        shared: None,
        ..System::bulk(&sample.layout, &sample.bulk, Symmetry::PositiveDefinite)
    };
    for (limit, engine) in [(9000, "cholesky+interface"), (0, "multifrontal_lu")] {
        let (report, error) = solve_known(&mut *single(limit), &system);
        assert_eq!(report.engine, engine);
        assert!(error < 1e-7 && report.relative_residual < 1e-10, "{engine}: {error}");
    }
}

/// A slender beam, clamped at one end, whose condition number (the fourth power of its length) is beyond single precision.
#[test]
fn where_single_precision_does_not_serve_double_does() {
    let n = 600;
    let mut triplets = Vec::new();
    for bend in 0..n {
        let at = [bend as isize - 2, bend as isize - 1, bend as isize];
        for (i, a) in at.into_iter().zip([1.0, -2.0, 1.0]).filter(|(i, _)| *i >= 0) {
            triplets.extend(
                at.into_iter()
                    .zip([1.0, -2.0, 1.0])
                    .filter(|(j, _)| *j >= 0)
                    .map(|(j, b)| (i as usize, j as usize, a * b)),
            );
        }
    }
    let (bulk, layout) = (Csr::from_triplets(n, &triplets), Layout::scalar(n));
    let system = System::bulk(&layout, &bulk, Symmetry::PositiveDefinite);
    let (in_double, error_in_double) = solve_known(&mut *direct(9000), &system);
    let (report, error) = solve_known(&mut *single(9000), &system);
    assert_eq!((report.engine, report.iterations), ("cholesky", in_double.iterations));
    assert_eq!(error, error_in_double);
}

/// Two chains of springs: the first held at its end, the second only through multipliers.
#[test]
fn chains_tied_by_a_multiplier() {
    let length = 300;
    let n = 2 * length + 2;
    let mut triplets = vec![(0, 0, 1e6)];
    for first in [0, length] {
        for i in first..first + length - 1 {
            triplets.extend([(i, i, 1e6), (i + 1, i + 1, 1e6), (i, i + 1, -1e6), (i + 1, i, -1e6)]);
        }
    }
    let bulk = Csr::from_triplets(n, &triplets);
    let mut layout = Layout::scalar(2 * length);
    layout.node.extend([length as u32, 2 * length as u32 - 1]);
    layout.multiplier.extend([true, true]);
    let (active, inactive) = (2 * length, 2 * length + 1);
    let coupling = Csr::from_triplets(
        n,
        &[
            (active, length, 1.0),
            (active, length - 1, -1.0),
            (length, active, 1.0),
            (length - 1, active, -1.0),
            (inactive, inactive, -1e-3),
            (2 * length - 1, inactive, 0.5),
        ],
    );
    let system = System { coupling: Some(&coupling), ..System::bulk(&layout, &bulk, Symmetry::PositiveDefinite) };
    let (report, error) = solve_known(&mut *direct(9000), &system);
    assert_eq!(report.engine, "cholesky+interface");
    assert!(error < 1e-6, "{error}");
    assert!(solve_known(&mut *direct(0), &system).1 < 1e-6);
}

#[test]
fn equal_stamps_reuse_and_new_ones_renew() {
    let sample = contact(6, 0.1, |at| at % 3 != 0);
    let mut system = System {
        coupling: Some(&sample.coupling),
        coupling_symmetric: false,
        shared: None,
        ..System::bulk(&sample.layout, &sample.bulk, Symmetry::PositiveDefinite)
    };
    let rhs = right_hand_side(system.equations());
    let mut solver = direct(9000);
    let mut solve = |system: &System<'_>| {
        let mut x = vec![0.0; rhs.len()];
        let report = solver.solve(system, &rhs, &mut x).expect("regular");
        (x, report)
    };
    let (first, _) = solve(&system);
    let (again, report) = solve(&system);
    assert_eq!(first, again);
    assert_eq!((report.seconds_symbolic, report.seconds_numeric), (0.0, 0.0));
    system.coupling_values += 1;
    assert_eq!(solve(&system).0, first);
    system.bulk_values += 1;
    assert_eq!(solve(&system).0, first);

    let other = contact(6, 0.1, |at| at % 4 != 0);
    let mut changed = System { coupling: Some(&other.coupling), coupling_graph: 1, coupling_values: 7, ..system };
    let (x, _) = solve(&changed);
    let mut r = vec![0.0; rhs.len()];
    assert!(changed.residual(&rhs, &x, &mut r) < 1e-9);
    let mut stiffer = sample.bulk.clone();
    stiffer.values.iter_mut().for_each(|value| *value *= 2.0);
    (changed.bulk, changed.bulk_values) = (&stiffer, 9);
    let (x, _) = solve(&changed);
    assert!(changed.residual(&rhs, &x, &mut r) < 1e-9);
}

#[test]
fn the_bulk_of_an_interface_need_not_be_definite_or_symmetric() {
    let sample = contact(7, 0.1, |at| at % 4 != 0);
    let mut indefinite = sample.bulk.clone();
    for i in 0..indefinite.rows {
        if let Some(at) = indefinite.find(i, i) {
            indefinite.values[at] -= 0.8e5;
        }
    }
    let mut unsymmetric = sample.bulk.clone();
    unsymmetric.values.iter_mut().enumerate().for_each(|(at, value)| *value *= 1.0 + 1e-3 * (at % 13) as f64);
    for (bulk, symmetry) in [(indefinite, Symmetry::Symmetric), (unsymmetric, Symmetry::General)] {
        let system = System {
            coupling: Some(&sample.coupling),
            coupling_symmetric: false,
            shared: None,
            ..System::bulk(&sample.layout, &bulk, symmetry)
        };
        let (report, error) = solve_known(&mut *direct(9000), &system);
        assert_eq!(report.engine, "multifrontal_lu+interface");
        assert!(error < 1e-6, "{symmetry:?}: {error}");
    }
}

#[test]
fn an_interface_may_move() {
    let brick = Brick::of_cubes([7; 3]);
    let (bulk, layout) = clamped_box(7);
    let n = bulk.rows;
    let mut solver = direct(9000);
    for step in 0..6 {
        let (a, b) = (brick.node(step, 0, 7), brick.node(7 - step, 7, 7));
        let spring = [(3 * a, 3 * a, 1.0), (3 * a, 3 * b, -1.0), (3 * b, 3 * a, -1.0), (3 * b, 3 * b, 1.0)];
        let coupling = Csr::from_triplets(n, &spring);
        let system = System {
            coupling: (step != 3).then_some(&coupling),
            coupling_graph: step as u64,
            coupling_values: step as u64,
            ..System::bulk(&layout, &bulk, Symmetry::PositiveDefinite)
        };
        let (report, error) = solve_known(&mut *solver, &system);
        assert_eq!(report.engine, "cholesky+interface");
        assert!(error < 1e-9, "step {step}: {error}");
    }
}

/// Graphs whose elimination trees are as deep or as wide as they get.
#[test]
fn odd_graphs_are_factorised() {
    let n = 20_000;
    let chain: Vec<(usize, usize, f64)> = (1..n).flat_map(|i| [(i, i - 1, -1.0), (i - 1, i, -1.0)]).collect();
    let star: Vec<(usize, usize, f64)> = (1..n).flat_map(|i| [(i, 0, -1.0), (0, i, -1.0)]).collect();
    let band: Vec<(usize, usize, f64)> = (0..n)
        .flat_map(|i| (1..20).filter(move |d| i + d < n).flat_map(move |d| [(i, i + d, -0.1), (i + d, i, -0.1)]))
        .collect();
    for (mut triplets, diagonal) in [(chain, 2.5), (star, 2.0 * n as f64), (band, 4.0), (Vec::new(), 3.0)] {
        triplets.extend((0..n).map(|i| (i, i, diagonal)));
        let (bulk, layout) = (Csr::from_triplets(n, &triplets), Layout::scalar(n));
        for symmetry in [Symmetry::PositiveDefinite, Symmetry::General] {
            let (_, error) = solve_known(&mut *direct(9000), &System::bulk(&layout, &bulk, symmetry));
            assert!(error < 1e-10, "{error}");
        }
    }
}

#[test]
fn a_singular_matrix_names_its_equations() {
    let brick = Brick::of_cubes([6, 6, 6]);
    let loose = Brick::of_cubes([2, 2, 2]);
    let mut triplets = Vec::new();
    brick.stiffness(0, 1.0, &mut triplets);
    loose.stiffness(brick.nodes(), 1.0, &mut triplets);
    fix(&mut triplets, brick.layer(0).into_iter().flat_map(|node| 3 * node..3 * node + 3), 1.0);
    let nodes = brick.nodes() + loose.nodes();
    let bulk = Csr::from_triplets(3 * nodes, &triplets);
    let layout = Layout::blocked(nodes, 3);
    let rhs = right_hand_side(3 * nodes);
    for (dense_below, single_from) in [(0, usize::MAX), (0, 0), (100_000, 0)] {
        let settings = DirectSettings { dense_below, single_from, ..Default::default() };
        let mut solver = create(Engine::Direct(settings));
        let mut x = vec![0.0; 3 * nodes];
        match solver.solve(&System::bulk(&layout, &bulk, Symmetry::PositiveDefinite), &rhs, &mut x) {
            Err(SolveError::Singular { equations, rank_deficiency }) => {
                assert!(!equations.is_empty() && equations.iter().all(|&i| i >= 3 * brick.nodes()), "{equations:?}");
                assert!(rank_deficiency.is_some());
            }
            other => panic!("a loose body was not noticed: {other:?}"),
        }
    }
}

#[test]
fn a_body_that_lost_contact_is_named() {
    for (n, limit) in [(3, 9000), (7, 9000), (7, 0), (10, 9000)] {
        let sample = contact(n, 0.1, |_| false);
        let system = System {
            coupling: Some(&sample.coupling),
            coupling_symmetric: false,
            shared: None,
            ..System::bulk(&sample.layout, &sample.bulk, Symmetry::PositiveDefinite)
        };
        let mut x = vec![0.0; system.equations()];
        let rhs = right_hand_side(x.len());
        match direct(limit).solve(&system, &rhs, &mut x) {
            Err(SolveError::Singular { equations, .. }) => {
                let lower = 3 * (n + 1).pow(3);
                assert!(
                    !equations.is_empty() && equations.iter().all(|&i| i >= lower && i < 2 * lower),
                    "{equations:?}"
                );
            }
            other => panic!("{n} cells: {other:?}"),
        }
    }
}

#[test]
fn unusable_input_is_refused() {
    let layout = Layout::scalar(3);
    let mut bulk = Csr::from_triplets(3, &[(0, 0, 1.0), (1, 1, 1.0), (2, 2, 1.0)]);
    let mut x = [0.0; 3];
    let solve = |bulk: &Csr, rhs: &[f64], x: &mut [f64]| {
        create(Engine::default()).solve(&System::bulk(&layout, bulk, Symmetry::PositiveDefinite), rhs, x)
    };
    assert_eq!(solve(&bulk, &[1.0, 2.0, 3.0], &mut x).unwrap().engine, "dense_lu");
    assert_eq!(x, [1.0, 2.0, 3.0]);
    assert_eq!(solve(&bulk, &[0.0; 3], &mut x).unwrap().relative_residual, 0.0);
    assert_eq!(x, [0.0; 3]);
    assert!(matches!(solve(&bulk, &[1.0, f64::NAN, 3.0], &mut x), Err(SolveError::Failed(_))));
    assert!(matches!(solve(&bulk, &[1.0], &mut x), Err(SolveError::Failed(_))));
    bulk.values[1] = 0.0;
    let singular = SolveError::Singular { equations: vec![1], rank_deficiency: Some(1) };
    assert_eq!(solve(&bulk, &[1.0, 2.0, 3.0], &mut x), Err(singular));
    bulk.values[1] = f64::INFINITY;
    assert!(matches!(solve(&bulk, &[1.0, 2.0, 3.0], &mut x), Err(SolveError::Failed(_))));
}

#[test]
fn the_bits_do_not_depend_on_the_threads() {
    let (bulk, layout) = clamped_box(13);
    let sample = contact(10, 0.1, |at| at % 5 != 0);
    let next = contact(10, 0.101, |at| at % 5 != 0);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let mut answers = Vec::new();
            for symmetry in [Symmetry::PositiveDefinite, Symmetry::General] {
                let system = System::bulk(&layout, &bulk, symmetry);
                let mut x = vec![0.0; system.equations()];
                direct(9000).solve(&system, &right_hand_side(x.len()), &mut x).expect("regular");
                answers.push(x);
            }
            for limit in [9000, 0] {
                let system = System {
                    coupling: Some(&sample.coupling),
                    coupling_symmetric: false,
                    shared: None,
                    ..System::bulk(&sample.layout, &sample.bulk, Symmetry::PositiveDefinite)
                };
                let mut solver = direct(limit);
                for system in [system, System { coupling: Some(&next.coupling), coupling_values: 1, ..system }] {
                    let mut x = vec![0.0; system.equations()];
                    solver.solve(&system, &right_hand_side(x.len()), &mut x).expect("regular");
                    answers.push(x);
                }
            }
            let mut x = vec![0.0; bulk.rows];
            let system = System::bulk(&layout, &bulk, Symmetry::PositiveDefinite);
            single(9000).solve(&system, &right_hand_side(x.len()), &mut x).expect("regular");
            answers.push(x);
            answers
        })
    };
    let one = run(1);
    for threads in [2, 3] {
        assert!(one == run(threads), "{threads} threads change the bits");
    }
}
