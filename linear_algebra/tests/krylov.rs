//! The Krylov engines with every preconditioner.

mod samples;

use samples::{clamped_box, contact};
use zelus_linear_algebra::{Engine, KrylovSettings, Preconditioner, Symmetry, System, create};

const PRECONDITIONERS: [Preconditioner; 3] =
    [Preconditioner::Identity, Preconditioner::BlockJacobi, Preconditioner::Ilu0];

fn engines(preconditioner: Preconditioner) -> [Engine; 2] {
    let settings = KrylovSettings { tolerance: 1e-9, iterations: 600, preconditioner, ..Default::default() };
    [Engine::ConjugateGradient(settings.clone()), Engine::Gmres { krylov: settings, restart: 100 }]
}

#[test]
fn every_preconditioner_converges() {
    let (bulk, layout) = clamped_box(9);
    let system = System::bulk(&layout, &bulk, Symmetry::PositiveDefinite);
    let rhs: Vec<f64> = (0..bulk.rows).map(|i| (i % 7) as f64 - 3.0).collect();
    for preconditioner in PRECONDITIONERS {
        for engine in engines(preconditioner) {
            let mut x = vec![0.0; bulk.rows];
            let mut solver = create(engine);
            let report = solver.solve(&system, &rhs, &mut x).expect("regular");
            assert_eq!((report.engine, report.fallback), (solver.name(), None), "{preconditioner:?}");
            assert!(report.relative_residual < 1e-8);
        }
    }
}

#[test]
fn what_they_cannot_do_goes_to_the_direct_engine() {
    let sample = contact(5, 0.0, |_| true);
    let system = System {
        coupling: Some(&sample.coupling),
        ..System::bulk(&sample.layout, &sample.bulk, Symmetry::PositiveDefinite)
    };
    let rhs = vec![1.0; system.equations()];
    let mut x = vec![0.0; rhs.len()];
    let [conjugate_gradient, gmres] = engines(Preconditioner::BlockJacobi);
    for engine in [conjugate_gradient, gmres] {
        let report = create(engine).solve(&system, &rhs, &mut x).expect("regular");
        assert_eq!(report.engine, "cholesky+interface");
        assert!(report.fallback.is_some_and(|why| why.contains("multipliers")));
    }
    let (bulk, layout) = clamped_box(6);
    let few = KrylovSettings { iterations: 3, preconditioner: Preconditioner::BlockJacobi, ..Default::default() };
    let mut x = vec![0.0; bulk.rows];
    let report = create(Engine::ConjugateGradient(few.clone()))
        .solve(&System::bulk(&layout, &bulk, Symmetry::PositiveDefinite), &vec![1.0; bulk.rows], &mut x)
        .expect("regular");
    assert!(report.fallback.is_some_and(|why| why.contains("3 iterations")));
    let unsymmetric = KrylovSettings { preconditioner: Preconditioner::Ilu0, ..Default::default() };
    x.fill(0.0);
    let report = create(Engine::ConjugateGradient(unsymmetric))
        .solve(&System::bulk(&layout, &bulk, Symmetry::General), &vec![1.0; bulk.rows], &mut x)
        .expect("regular");
    assert_eq!((report.engine, report.fallback.is_some()), ("gmres", true));
}

#[test]
fn the_bits_do_not_depend_on_the_threads() {
    let (bulk, layout) = clamped_box(12);
    let rhs: Vec<f64> = (0..bulk.rows).map(|i| (i % 7) as f64 - 3.0).collect();
    let run = |threads: usize, engine: Engine| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let mut x = vec![0.0; bulk.rows];
            let system = System::bulk(&layout, &bulk, Symmetry::PositiveDefinite);
            create(engine).solve(&system, &rhs, &mut x).expect("regular");
            x
        })
    };
    for preconditioner in PRECONDITIONERS {
        for engine in engines(preconditioner) {
            assert!(run(1, engine.clone()) == run(2, engine), "{preconditioner:?}");
        }
    }
}
