//! Times the direct solver on elastic boxes: `solver_timing CELLS [THREADS]`.

#[path = "../tests/samples/mod.rs"]
mod samples;

use samples::{Brick, contact, fix};
use zelus_linear_algebra::{
    Csr, DirectSettings, Engine, KrylovSettings, Layout, Preconditioner, SolveReport, Symmetry, System, create,
};

fn show(what: &str, report: &SolveReport) {
    println!(
        "{what:34} {:26} residual {:.1e} ({:2} steps) | symbolic {:.3} numeric {:.3} solve {:.3} s{}",
        report.engine,
        report.relative_residual,
        report.iterations,
        report.seconds_symbolic,
        report.seconds_numeric,
        report.seconds_solve,
        report.fallback.as_ref().map(|text| format!(" [{text}]")).unwrap_or_default(),
    );
}

fn main() {
    let mut arguments = std::env::args().skip(1).map(|text| text.parse::<usize>().expect("a number"));
    let cells = arguments.next().unwrap_or(20);
    let threads = arguments.next().unwrap_or(0);
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().expect("a pool");

    let brick = Brick::of_cubes([cells; 3]);
    let mut triplets = Vec::new();
    brick.stiffness(0, 1.0, &mut triplets);
    fix(&mut triplets, brick.layer(0).into_iter().flat_map(|node| 3 * node..3 * node + 3), 1.0);
    let bulk = Csr::from_triplets(3 * brick.nodes(), &triplets);
    drop(triplets);
    let layout = Layout::blocked(brick.nodes(), 3);
    let rhs: Vec<f64> = (0..bulk.rows).map(|i| ((i * 7919) % 1000) as f64 / 1000.0 - 0.5).collect();
    let mut x = vec![0.0; bulk.rows];
    println!("one box: {} equations, {} entries", bulk.rows, bulk.entries());
    let mut system = System::bulk(&layout, &bulk, Symmetry::PositiveDefinite);
    let mut solver = create(Engine::default());
    show("first", &solver.solve(&system, &rhs, &mut x).expect("solved"));
    show("again", &solver.solve(&system, &rhs, &mut x).expect("solved"));
    system.bulk_values += 1;
    show("new values", &solver.solve(&system, &rhs, &mut x).expect("solved"));
    system.bulk_symmetry = Symmetry::General;
    let mut solver = create(Engine::default());
    show("as a general matrix", &solver.solve(&system, &rhs, &mut x).expect("solved"));
    drop(solver);
    let mut layout = layout;
    layout.near_null_space = brick.rigid_motions();
    let system = System::bulk(&layout, &bulk, Symmetry::PositiveDefinite);
    let mut solver = create(Engine::ConjugateGradient(KrylovSettings::default()));
    x.fill(0.0);
    show("multigrid", &solver.solve(&system, &rhs, &mut x).expect("solved"));
    x.fill(0.0);
    show("again", &solver.solve(&system, &rhs, &mut x).expect("solved"));
    let jacobi = KrylovSettings { preconditioner: Preconditioner::BlockJacobi, ..Default::default() };
    let mut solver = create(Engine::ConjugateGradient(jacobi));
    x.fill(0.0);
    show("block Jacobi", &solver.solve(&system, &rhs, &mut x).expect("solved"));

    let sample = contact(cells * 4 / 5, 0.1, |at| at % 5 != 0);
    println!("two boxes: {} equations, {} entries of coupling", sample.bulk.rows, sample.coupling.entries());
    let rhs: Vec<f64> = (0..sample.bulk.rows).map(|i| ((i * 7919) % 1000) as f64 / 1000.0 - 0.5).collect();
    let mut x = vec![0.0; sample.bulk.rows];
    let mut system = System {
        coupling: Some(&sample.coupling),
        coupling_symmetric: false,
        shared: None,
        ..System::bulk(&sample.layout, &sample.bulk, Symmetry::PositiveDefinite)
    };
    let mut solver = create(Engine::default());
    show("first", &solver.solve(&system, &rhs, &mut x).expect("solved"));
    system.coupling_values += 1;
    show("new coupling", &solver.solve(&system, &rhs, &mut x).expect("solved"));
    show("again", &solver.solve(&system, &rhs, &mut x).expect("solved"));
    system.bulk_values += 1;
    show("new bulk", &solver.solve(&system, &rhs, &mut x).expect("solved"));
    let settings = DirectSettings { interface_limit: 0, ..Default::default() };
    let mut solver = create(Engine::Direct(settings));
    show("without dense interface", &solver.solve(&system, &rhs, &mut x).expect("solved"));
}
