//! Multigrid alone and on systems with multipliers, against the direct engine.

mod samples;

use samples::{Brick, Contact, clamped_box, contact, held};
use zelus_linear_algebra::{
    Csr, Engine, Layout, LinearSolver, MultigridSettings, SolveReport, State, Symmetry, System, create, packed,
};

/// Largest difference from the answer of the direct engine, as a share of the largest value.
const AGREE: f64 = 1e-8;

fn load(equations: usize) -> Vec<f64> {
    (0..equations).map(|i| (i % 7) as f64 - 3.0).collect()
}

fn multigrid(system: &System<'_>, rhs: &[f64]) -> (Vec<f64>, SolveReport) {
    multigrid_to(1e-11, system, rhs)
}

fn multigrid_to(tolerance: f64, system: &System<'_>, rhs: &[f64]) -> (Vec<f64>, SolveReport) {
    let mut x = vec![0.0; rhs.len()];
    let engine = Engine::Multigrid(MultigridSettings {
        tolerance,
        iterations: 200,
        least: [0; 2],
        ..MultigridSettings::default()
    });
    let report = create(engine).solve(system, rhs, &mut x).expect("regular");
    (x, report)
}

/// The largest difference between two answers on the displacements and on the multipliers, each over its largest value.
fn differences(layout: &Layout, a: &[f64], b: &[f64]) -> [f64; 2] {
    [false, true].map(|multiplier| {
        let of = (0..a.len()).filter(|&i| layout.multiplier[i] == multiplier);
        let [difference, size] = of.fold([0.0_f64; 2], |[d, s], i| [d.max((a[i] - b[i]).abs()), s.max(b[i].abs())]);
        if size > 0.0 { difference / size } else { difference }
    })
}

#[test]
fn iterations_hardly_grow() {
    let iterations = [8, 16, 24].map(|cells| {
        let (bulk, layout) = clamped_box(cells);
        let system = System::bulk(&layout, &bulk, Symmetry::PositiveDefinite);
        let (_, report) = multigrid(&system, &load(bulk.rows));
        assert_eq!((report.engine, report.fallback), ("multigrid", None));
        assert!(report.relative_residual < 1e-10);
        report.iterations
    });
    assert!(iterations[2] <= iterations[0] + 10 && iterations[2] < 35, "{iterations:?}");
}

/// REGRESSION: 17, 30, 23 and 20 iterations were measured, 33, 132, 99 and 200 with smoothers of single nodes.
#[test]
fn flat_cells_and_thin_walls_take_few_iterations() {
    for (cells, edges, most) in [
        ([20; 3], [4.0, 4.0, 1.0], 22),
        ([20; 3], [10.0, 10.0, 1.0], 36),
        ([50, 50, 2], [2.0, 2.0, 0.5], 30),
        ([40, 40, 4], [8.0, 5.0, 1.0], 26),
    ] {
        let brick = Brick::of_cells(cells, edges);
        let edges_held = [0, cells[0]].into_iter().flat_map(|i| (0..=cells[1]).map(move |j| [i, j]));
        let nodes = edges_held.flat_map(|[i, j]| (0..=cells[2]).map(move |k| [i, j, k]));
        let nodes = nodes.map(|[i, j, k]| brick.node(i, j, k)).collect();
        let (bulk, layout) = held(&brick, nodes);
        let system = System::bulk(&layout, &bulk, Symmetry::PositiveDefinite);
        let (_, report) = multigrid_to(1e-7, &system, &load(bulk.rows));
        println!("{cells:?} cells of {edges:?}: {} iterations, {:.1e}", report.iterations, report.relative_residual);
        assert_eq!((report.engine, report.fallback), ("multigrid", None));
        assert!(report.relative_residual < 1e-6 && report.iterations <= most, "{cells:?} of {edges:?}");
    }
}

/// Places at equal distances from zero on.
fn even(cells: usize, length: f64) -> Vec<f64> {
    (0..=cells).map(|at| length * at as f64 / cells as f64).collect()
}

/// Places from zero on, at distances that grow evenly by this ratio in all, of which the smallest is one.
fn growing(cells: usize, ratio: f64) -> Vec<f64> {
    let edge = |at: usize| ratio.powf(at as f64 / (cells - 1) as f64);
    (0..=cells).map(|at| (0..at).map(edge).sum()).collect()
}

/// Places from zero on: some at equal distances of one, the rest at distances that grow by 1.7 from each to the next.
fn refined(equal: usize, growing: usize) -> Vec<f64> {
    (0..=equal + growing)
        .map(|at| at.min(equal) as f64 + (0..at.saturating_sub(equal)).map(|k| 1.7_f64.powi(k as i32 + 1)).sum::<f64>())
        .collect()
}

/// Iterations for seven digits of a body that is held at its last layer, or at its first edge, by an uneven load and by an even one.
fn iterations_of(stations: [Vec<f64>; 3], by_edge: bool) -> [usize; 2] {
    let brick = Brick { stations };
    let [x, y, z] = brick.counts();
    let nodes = if by_edge {
        (0..z).flat_map(|k| (0..y).map(move |j| [j, k])).map(|[j, k]| brick.node(0, j, k)).collect()
    } else {
        brick.layer(z - 1)
    };
    let (bulk, layout) = held(&brick, nodes);
    let system = System::bulk(&layout, &bulk, Symmetry::PositiveDefinite);
    let even: Vec<f64> = (0..3 * x * y * z).map(|i| [0.3, 0.5, 1.0][i % 3]).collect();
    [load(bulk.rows), even].map(|rhs| {
        let (_, report) = multigrid_to(1e-7, &system, &rhs);
        assert_eq!((report.engine, report.fallback), ("multigrid", None));
        assert!(report.relative_residual < 1e-6);
        report.iterations
    })
}

/// REGRESSION: 29 and 32, 23 and 28, 31 and 29, 38 and 43, 33 and 29 iterations were measured. With aggregates across long edges and solves in
/// single precision alone it took 128 and 170, 116 and 142, more than 500, 319 and 427, more than 500.
#[test]
fn graded_and_long_cells_take_few_iterations() {
    let flat = |unit: f64| growing(24, 1000.0).iter().map(|z| z * unit).collect::<Vec<f64>>();
    for (name, stations, most) in [
        ("refined towards a corner", [refined(8, 8), refined(8, 8), refined(0, 8)], [30, 35]),
        ("1:1000, flat at one end", [even(16, 1.0), even(16, 1.0), flat(1.0 / 3000.0)], [30, 35]),
        ("1:1000, long at the other", [even(16, 1.0), even(16, 1.0), flat(0.01)], [36, 36]),
        ("1:1000 in each direction", [growing(16, 1000.0), growing(16, 1000.0), growing(16, 1000.0)], [44, 50]),
        ("long cells of 1:20", [even(16, 1.0), even(16, 1.0), even(16, 20.0)], [36, 40]),
    ] {
        let found = iterations_of(stations, false);
        println!("{name}: {found:?} iterations");
        assert!(found.iter().zip(most).all(|(found, most)| *found <= most), "{name}: {found:?}");
    }
}

/// REGRESSION: 43 and 43, 23 and 26, 35 and 40, 24 and 42 iterations were measured. Solves in single precision alone do not serve bodies so
/// soft: it took 264 and 281, 82 and 88, 96 and 93, and more than 500 for the beam.
#[test]
fn soft_bodies_take_few_iterations() {
    for (name, stations, most) in [
        ("sheet of 1:100", [even(50, 100.0), even(50, 100.0), even(2, 1.0)], [48, 48]),
        ("strip of 1:100", [even(100, 100.0), even(10, 10.0), even(2, 1.0)], [30, 35]),
        ("block of flat cells", [even(20, 10.0), even(20, 10.0), even(20, 1.0)], [42, 46]),
        ("beam of 1:100", [even(200, 100.0), even(2, 1.0), even(2, 1.0)], [32, 48]),
    ] {
        let found = iterations_of(stations, true);
        println!("{name}: {found:?} iterations");
        assert!(found.iter().zip(most).all(|(found, most)| *found <= most), "{name}: {found:?}");
    }
}

/// The sample of tied boxes with the rigid-body modes of each.
fn tied(cells: usize, skew: f64, active: impl Fn(usize) -> bool) -> Contact {
    let mut sample = contact(cells, skew, active);
    let brick = Brick::of_cubes([cells; 3]);
    let motions = brick.rigid_motions();
    let equations = sample.layout.equations();
    sample.layout.near_null_space = motions
        .into_iter()
        .map(|motion| {
            let mut both = motion.repeat(2);
            both.resize(equations, 0.0);
            both
        })
        .collect();
    sample
}

#[test]
fn multipliers_leave_by_their_constraints() {
    for (skew, cells) in [(0.0, 6), (0.0, 12), (0.3, 8)] {
        for active in [|_: usize| true, |at: usize| !at.is_multiple_of(5)] {
            let sample = tied(cells, skew, active);
            let system = System {
                coupling: Some(&sample.coupling),
                coupling_symmetric: skew == 0.0,
                shared: None,
                ..System::bulk(&sample.layout, &sample.bulk, Symmetry::PositiveDefinite)
            };
            let rhs = load(system.equations());
            let (x, report) = multigrid(&system, &rhs);
            assert_eq!((report.engine, report.fallback), ("multigrid", None), "{skew} {cells}");
            assert!(report.iterations < 60, "{} iterations", report.iterations);
            let mut direct = vec![0.0; rhs.len()];
            create(Engine::default()).solve(&system, &rhs, &mut direct).expect("regular");
            let differences = differences(&sample.layout, &x, &direct);
            assert!(differences.iter().all(|d| *d < AGREE), "{differences:?}");
        }
    }
}

/// Two boxes that slide on each other, springs hold the upper one sideways.
fn sliding(cells: usize) -> Contact {
    let mut sample = tied(cells, 0.0, |_| true);
    let layout = &sample.layout;
    let multipliers: Vec<usize> = (0..layout.equations()).filter(|&i| layout.multiplier[i]).collect();
    let mut triplets = Vec::new();
    for i in 0..layout.equations() {
        let is_tangential = |e: usize| e >= multipliers[0] && (e - multipliers[0]) % 3 != 2;
        let (columns, values) = sample.coupling.row(i);
        let of_row = columns.iter().zip(values).map(|(&j, &value)| (i, j as usize, value));
        triplets.extend(of_row.filter(|&(i, j, _)| !is_tangential(i) && !is_tangential(j)));
        triplets.extend(is_tangential(i).then_some((i, i, -0.01)));
    }
    sample.coupling = Csr::from_triplets(layout.equations(), &triplets);
    let brick = Brick::of_cubes([cells; 3]);
    for node in brick.layer(cells) {
        for direction in 0..2 {
            let equation = 3 * (brick.nodes() + node) + direction;
            let at = sample.bulk.find(equation, equation).expect("a diagonal");
            sample.bulk.values[at] *= 1.1;
        }
    }
    sample
}

#[test]
fn bodies_that_slide_need_the_iterations_of_one() {
    let iterations = [6, 10, 16].map(|cells| {
        let sample = sliding(cells);
        let system = System {
            coupling: Some(&sample.coupling),
            ..System::bulk(&sample.layout, &sample.bulk, Symmetry::PositiveDefinite)
        };
        let (_, report) = multigrid(&system, &load(system.equations()));
        assert_eq!((report.engine, report.fallback), ("multigrid", None));
        report.iterations
    });
    let (bulk, layout) = clamped_box(18);
    let (_, alone) = multigrid(&System::bulk(&layout, &bulk, Symmetry::PositiveDefinite), &load(bulk.rows));
    assert!(iterations.iter().all(|&count| count <= alone.iterations + 2), "{iterations:?}, {}", alone.iterations);
}

#[test]
fn a_multiplier_without_a_node_of_its_own_is_carried_by_a_master() {
    let mut sample = tied(6, 0.0, |_| true);
    let lone = sample.layout.equations() - 1;
    sample.layout.node[lone] = sample.layout.node.iter().max().expect("equations") + 1;
    let system = System {
        coupling: Some(&sample.coupling),
        ..System::bulk(&sample.layout, &sample.bulk, Symmetry::PositiveDefinite)
    };
    let rhs = load(system.equations());
    let (x, report) = multigrid(&system, &rhs);
    assert_eq!((report.engine, report.fallback), ("multigrid", None));
    let mut direct = vec![0.0; rhs.len()];
    create(Engine::default()).solve(&system, &rhs, &mut direct).expect("regular");
    let differences = differences(&sample.layout, &x, &direct);
    assert!(differences.iter().all(|d| *d < AGREE), "{differences:?}");
}

#[test]
fn what_does_not_converge_goes_to_the_direct_engine() {
    let (bulk, layout) = clamped_box(12);
    let system = System::bulk(&layout, &bulk, Symmetry::PositiveDefinite);
    let mut solver = create(Engine::Multigrid(MultigridSettings {
        tolerance: 1e-11,
        iterations: 3,
        least: [0; 2],
        ..MultigridSettings::default()
    }));
    let rhs = load(bulk.rows);
    for reason in [Some("after 3 iterations"), Some("after 3 iterations"), Some("failed before"), None] {
        let mut x = vec![0.0; bulk.rows];
        let report = solver.solve(&system, &rhs, &mut x).expect("regular");
        assert!(report.relative_residual < 1e-10);
        let told = report.fallback.as_deref();
        assert!(told.is_some() == reason.is_some() && told.unwrap_or_default().contains(reason.unwrap_or_default()));
    }
}

#[test]
fn the_bits_do_not_depend_on_the_threads() {
    let sample = tied(10, 0.1, |at| !at.is_multiple_of(3));
    let system = System {
        coupling: Some(&sample.coupling),
        ..System::bulk(&sample.layout, &sample.bulk, Symmetry::PositiveDefinite)
    };
    let rhs = load(system.equations());
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| multigrid(&system, &rhs).0)
    };
    assert!(run(1) == run(3));
}

/// Steps of two solves each, whose matrices differ in a few diagonals; the engine's state goes through a file after the third.
#[test]
fn levels_of_earlier_matrices_are_part_of_the_state() {
    let (bulk, layout) = clamped_box(10);
    let engine = || Engine::Multigrid(MultigridSettings { least: [0; 2], ..MultigridSettings::default() });
    let solve = |solver: &mut dyn LinearSolver, step: u64| {
        let mut x = vec![0.0; bulk.rows];
        solver.forget();
        for bulk_values in [2 * step, 2 * step + 1] {
            let mut changed = bulk.clone();
            for i in (0..bulk.rows).step_by(50) {
                let at = changed.find(i, i).expect("a diagonal");
                changed.values[at] *= 1.0 + 0.01 * bulk_values as f64;
            }
            let system = System { bulk_values, ..System::bulk(&layout, &changed, Symmetry::PositiveDefinite) };
            x.fill(0.0);
            solver.solve(&system, &load(bulk.rows), &mut x).expect("regular");
        }
        x
    };
    let mut one = create(engine());
    (0..3).for_each(|step| drop(solve(one.as_mut(), step)));
    let state = one.state().expect("a state");
    let file = packed::to_bytes(&state).expect("a state is written");
    let state: Box<dyn State> = packed::from_bytes(&file).expect("a state is read");
    let mut other = create(engine());
    other.resume(state).expect("a state of its own");
    let mut fresh = create(engine());
    let [one, other, fresh] = [&mut one, &mut other, &mut fresh].map(|solver| solve(solver.as_mut(), 3));
    assert!(one == other);
    assert!(one != fresh, "the levels in use are earlier ones");
}

/// A solve that costs more than a factorisation hands the rest of the run over; one that does not, or may not, keeps multigrid.
#[test]
fn the_direct_engine_takes_over_where_it_costs_less() {
    let (bulk, layout) = clamped_box(13);
    let system = System::bulk(&layout, &bulk, Symmetry::PositiveDefinite);
    let engines = |tolerance: f64, falls_back: bool| {
        let settings = MultigridSettings {
            least: [0; 2],
            tolerance,
            loosest: tolerance,
            falls_back,
            ..MultigridSettings::default()
        };
        let mut solver = create(Engine::Multigrid(settings));
        [0, 1].map(|shift| {
            // Loads that are no multiples of each other.
            let rhs: Vec<f64> = (0..bulk.rows).map(|i| ((i * i + shift) % 19) as f64 - 9.0).collect();
            let report = solver.solve(&system, &rhs, &mut vec![0.0; bulk.rows]).expect("regular");
            (report.engine == "multigrid", report.fallback.is_some_and(|why| why.contains("costs less")))
        })
    };
    assert_eq!(engines(1e-12, true), [(false, true), (false, false)]);
    assert_eq!(engines(1e-12, false), [(true, false); 2]);
    assert_eq!(engines(1e-2, true), [(true, false); 2]);
}

/// A system with inactive equations, and the same without them.
struct InactiveRows {
    whole: Contact,
    left: Contact,
    equations: Vec<usize>,
}

fn inactive_rows(cells: usize, is_inactive: impl Fn(usize, &Layout) -> bool) -> InactiveRows {
    let mut whole = tied(cells, 0.0, |_| true);
    let n = whole.layout.equations();
    whole.layout.inactive = (0..n).map(|i| is_inactive(i, &whole.layout)).collect();
    let equations: Vec<usize> = (0..n).filter(|&i| !whole.layout.inactive[i]).collect();
    let number = |i: usize| equations.binary_search(&i).ok();
    let matrix = |of: &Csr| {
        let entries = equations.iter().enumerate().flat_map(|(row, &i)| {
            let (columns, values) = of.row(i);
            columns.iter().zip(values).filter_map(move |(&j, &value)| Some((row, number(j as usize)?, value)))
        });
        Csr::from_triplets(equations.len(), &entries.collect::<Vec<_>>())
    };
    let layout = Layout {
        node: equations.iter().map(|&i| whole.layout.node[i]).collect(),
        multiplier: equations.iter().map(|&i| whole.layout.multiplier[i]).collect(),
        near_null_space: whole
            .layout
            .near_null_space
            .iter()
            .map(|vector| equations.iter().map(|&i| vector[i]).collect())
            .collect(),
        ..Layout::default()
    };
    let left = Contact { bulk: matrix(&whole.bulk), coupling: matrix(&whole.coupling), layout };
    InactiveRows { whole, left, equations }
}

fn system(of: &Contact) -> System<'_> {
    System { coupling: Some(&of.coupling), ..System::bulk(&of.layout, &of.bulk, Symmetry::PositiveDefinite) }
}

#[test]
fn equations_that_are_held_are_none() {
    // Of every seventh node all, and of the nodes of one layer the first one.
    let is_inactive = |i: usize, layout: &Layout| {
        let first = i == 0 || layout.node[i - 1] != layout.node[i];
        layout.node[i].is_multiple_of(7) || first && (162..243).contains(&layout.node[i])
    };
    let sample = inactive_rows(8, is_inactive);
    let n = sample.whole.layout.equations();
    // Numbers at inactive rows are not used.
    let rhs: Vec<f64> =
        load(n).iter().enumerate().map(|(i, b)| if sample.whole.layout.inactive[i] { 1e6 } else { *b }).collect();
    let gather = |of: &[f64]| sample.equations.iter().map(|&i| of[i]).collect::<Vec<f64>>();
    let (expected, of_left) = multigrid(&system(&sample.left), &gather(&rhs));
    let (x, report) = multigrid(&system(&sample.whole), &rhs);
    assert_eq!((report.engine, report.fallback), ("multigrid", None));
    assert_eq!(report.iterations, of_left.iterations);
    for (a, b) in gather(&x).iter().zip(&expected) {
        assert!((a - b).abs() <= AGREE * b.abs().max(1e-3), "{a} {b}");
    }
    assert!((0..n).all(|i| !sample.whole.layout.inactive[i] || x[i] == 0.0));
}

#[test]
fn what_the_direct_engine_takes_over_has_no_held_equations() {
    let is_inactive = |i: usize, layout: &Layout| layout.node[i].is_multiple_of(7);
    let sample = inactive_rows(5, is_inactive);
    let rhs = load(sample.whole.layout.equations());
    let solve = |least: usize| {
        let mut x = vec![0.0; rhs.len()];
        let engine = Engine::Multigrid(MultigridSettings {
            tolerance: 1e-11,
            iterations: 200,
            least: [least; 2],
            ..MultigridSettings::default()
        });
        let report = create(engine).solve(&system(&sample.whole), &rhs, &mut x).expect("regular");
        (x, report.engine)
    };
    let ((x, by_multigrid), (other, by_direct)) = (solve(0), solve(usize::MAX));
    assert_eq!(by_multigrid, "multigrid");
    assert_ne!(by_direct, "multigrid");
    let [displacements, multipliers] = differences(&sample.whole.layout, &x, &other);
    assert!(displacements < AGREE && multipliers < AGREE, "{displacements:.1e} {multipliers:.1e}");
}
