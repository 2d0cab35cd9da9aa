//! Distributed solves under mpirun at 1, 2 and 4 ranks; says so when they cannot be run.

#[cfg(not(feature = "petsc"))]
fn main() {
    if !lists() {
        println!("skipped: built without the feature `petsc`");
    }
}

/// Answers a runner that asks which tests there are.
fn lists() -> bool {
    let asks = |word: &str| std::env::args().any(|argument| argument == word);
    if asks("--list") && !asks("--ignored") {
        println!("distributed_solves: test");
    }
    asks("--list")
}

#[cfg(feature = "petsc")]
mod support;

#[cfg(feature = "petsc")]
fn main() {
    match std::env::var("ZELUS_PETSC_WORKER") {
        Ok(_) => cases::all(),
        Err(_) if lists() => (),
        Err(_) => launch(),
    }
}

/// Starts this program under mpirun, once for each number of ranks.
#[cfg(feature = "petsc")]
fn launch() {
    use std::process::Command;

    let own = std::env::current_exe().expect("the path of this program");
    for ranks in ["1", "2", "4"] {
        let mut run = Command::new("mpirun");
        run.args(["-n", ranks]).arg(&own).env("ZELUS_PETSC_WORKER", "1");
        // tests may run as root and on fewer cores than ranks
        for name in ["OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "OMPI_MCA_rmaps_base_oversubscribe"] {
            run.env(name, "1");
        }
        run.envs([("OMP_NUM_THREADS", "1"), ("OPENBLAS_NUM_THREADS", "1")]);
        match run.status() {
            Err(_) => return println!("skipped: there is no mpirun"),
            Ok(status) => assert!(status.success(), "{ranks} ranks: {status}"),
        }
    }
}

#[cfg(feature = "petsc")]
mod cases {
    use zelus_linear_algebra::{SolveError, SolveReport, Symmetry};
    use zelus_petsc::{Communicator, DistributedSolver, PetscEngine, PetscSettings, Session};

    use super::support::{Rows, elasticity, poisson, saddle};

    fn settings(engine: PetscEngine) -> PetscSettings {
        PetscSettings { engine: Some(engine), ..PetscSettings::default() }
    }

    /// Solves for the expected answer; gives the largest error of an owned entry and the report.
    fn solve(
        solver: &mut DistributedSolver,
        rows: &Rows,
        stamps: (u64, u64),
    ) -> Result<(f64, SolveReport), SolveError> {
        let mut x = vec![0.0; rows.len()];
        let report = solver.solve(&rows.matrix(stamps.0, stamps.1), &rows.rhs(), &mut x)?;
        assert!(report.relative_residual <= 1e-6, "{report:?}");
        Ok((rows.error(&x), report))
    }

    pub fn all() {
        let session = Session::start().unwrap();
        let world = session.world();
        let (rank, size) = world.rank_and_size();
        let cases: [(&str, fn(Communicator)); 8] = [
            ("every engine solves Poisson's problem", every_engine),
            ("multigrid with rigid modes solves elasticity", multigrid),
            ("saddle points are factorised", saddles),
            ("singular matrices are reported with their equations", singular),
            ("what is unchanged is kept", reuse),
            ("options are passed on, and named when nothing reads them", options),
            ("a rank with bad input stops all", disagreement),
            ("ranks may own nothing", empty_ranks),
        ];
        for (what, case) in cases {
            case(world);
            if rank == 0 {
                println!("{size} ranks: {what} ... ok");
            }
        }
    }

    fn every_engine(world: Communicator) {
        let (rank, size) = world.rank_and_size();
        let rows = Rows::new(&poisson(12, true), rank, size, Symmetry::PositiveDefinite);
        for engine in PetscEngine::ALL {
            let mut solver = DistributedSolver::new(world, settings(engine));
            let (error, report) = solve(&mut solver, &rows, (0, 0)).unwrap();
            let tolerance = if engine.is_direct() { 1e-12 } else { 1e-7 };
            assert!(error < tolerance && report.engine == engine.name(), "{error:e} {report:?}");
            assert_eq!(report.fallback, None);
        }
    }

    fn multigrid(world: Communicator) {
        let (rank, size) = world.rank_and_size();
        for guided in [false, true] {
            let (entries, modes) = elasticity(9, guided);
            let mut rows = Rows::new(&entries, rank, size, Symmetry::PositiveDefinite);
            let owned = rows.first..rows.first + rows.len();
            let mut own = modes.clone();
            own.coordinates = modes.coordinates[owned.clone()].to_vec();
            own.components = modes.components[owned].to_vec();
            rows.modes = Some(own);
            let mut solver = DistributedSolver::new(world, settings(PetscEngine::CgGamg));
            let (error, report) = solve(&mut solver, &rows, (0, 0)).unwrap();
            assert!(error < 1e-6 && report.fallback.is_none(), "{error:e} {report:?}");
            assert!(report.iterations <= 40, "{report:?}");
            if rank == 0 {
                println!("  guided {guided}: {} iterations, error {error:.1e}", report.iterations);
            }
        }
    }

    fn saddles(world: Communicator) {
        let (rank, size) = world.rank_and_size();
        let symmetric = Rows { has_multipliers: true, ..Rows::new(&saddle(7, 0.0), rank, size, Symmetry::Symmetric) };
        let general = Rows { has_multipliers: true, ..Rows::new(&saddle(7, 0.5), rank, size, Symmetry::General) };
        for (rows, engine) in [(symmetric, "mumps_ldlt"), (general, "mumps_lu")] {
            let mut solver = DistributedSolver::new(world, PetscSettings::default());
            let (error, report) = solve(&mut solver, &rows, (0, 0)).unwrap();
            assert!(error < 1e-11 && report.engine == engine, "{error:e} {report:?}");
            assert!(report.relative_residual < 1e-13, "{report:?}");
        }
    }

    fn singular(world: Communicator) {
        let (rank, size) = world.rank_and_size();
        let free = Rows::new(&poisson(6, false), rank, size, Symmetry::PositiveDefinite);
        let mut twice = saddle(5, 0.0);
        // the last multiplier says the same as the first
        let (first, last) = (125, twice.len() - 1);
        for column in std::mem::take(&mut twice[last]).into_keys() {
            twice[column].remove(&last);
        }
        for (column, value) in twice[first].clone() {
            twice[last].insert(column, value);
            twice[column].insert(last, value);
        }
        let doubled = Rows::new(&twice, rank, size, Symmetry::Symmetric);
        for (rows, what) in [(&free, "a free motion"), (&doubled, "a multiplier twice")] {
            for engine in PetscEngine::ALL.into_iter().filter(|engine| engine.is_direct()) {
                let mut solver = DistributedSolver::new(world, settings(engine));
                let mut x = vec![0.0; rows.len()];
                let mut rhs = vec![0.0; rows.len()];
                rhs.iter_mut().enumerate().for_each(|(at, b)| *b = f64::from(rows.first + at == 3));
                let error = solver.solve(&rows.matrix(0, 0), &rhs, &mut x).unwrap_err();
                let SolveError::Singular { equations, rank_deficiency } = &error else {
                    panic!("{what}, {}: {error}", engine.name())
                };
                assert_eq!(*rank_deficiency, Some(1), "{what}, {}: {error}", engine.name());
                assert!(!equations.is_empty(), "{what}: {error}");
            }
        }
    }

    fn reuse(world: Communicator) {
        let (rank, size) = world.rank_and_size();
        let mut rows = Rows::new(&poisson(14, true), rank, size, Symmetry::PositiveDefinite);
        for engine in PetscEngine::ALL {
            let mut solver = DistributedSolver::new(world, settings(engine));
            let (_, first) = solve(&mut solver, &rows, (1, 1)).unwrap();
            let (_, again) = solve(&mut solver, &rows, (1, 1)).unwrap();
            assert!(again.seconds_numeric < 0.2 * first.seconds_numeric + 0.005, "{first:?} {again:?}");
            rows.values.iter_mut().for_each(|value| *value *= 3.0);
            let (error, _) = solve(&mut solver, &rows, (1, 2)).unwrap();
            assert!(error < 1e-6, "{error:e}");
            let finer = Rows::new(&poisson(5, true), rank, size, Symmetry::PositiveDefinite);
            let (error, _) = solve(&mut solver, &finer, (2, 3)).unwrap();
            assert!(error < 1e-6, "{error:e}");
        }
    }

    fn options(world: Communicator) {
        let (rank, size) = world.rank_and_size();
        let rows = Rows::new(&poisson(6, true), rank, size, Symmetry::PositiveDefinite);
        let options = "-mat_mumps_icntl_14 37 -ksp_nonsense 5".to_owned();
        let mut solver = DistributedSolver::new(world, PetscSettings { options, ..settings(PetscEngine::MumpsLu) });
        solve(&mut solver, &rows, (0, 0)).unwrap();
        assert_eq!(solver.unread_options(), ["-ksp_nonsense"]);
        let options = "-pc_type jacobi -ksp_max_it 500".to_owned();
        let mut solver = DistributedSolver::new(world, PetscSettings { options, ..settings(PetscEngine::CgGamg) });
        let (error, report) = solve(&mut solver, &rows, (0, 0)).unwrap();
        assert!(error < 1e-6 && report.iterations > 10, "{report:?}");
        let options = "-pc_type no_such_thing".to_owned();
        let mut solver = DistributedSolver::new(world, PetscSettings { options, ..settings(PetscEngine::MumpsLu) });
        let error = solve(&mut solver, &rows, (0, 0)).unwrap_err();
        assert!(error.to_string().contains("no_such_thing"), "{error}");
        let options = "-ksp_max_it 2 -pc_type none".to_owned();
        let mut solver = DistributedSolver::new(world, PetscSettings { options, ..settings(PetscEngine::CgGamg) });
        let (_, report) = solve(&mut solver, &rows, (0, 0)).unwrap();
        assert!(report.fallback.is_some() && report.engine == "mumps_ldlt", "{report:?}");
    }

    fn disagreement(world: Communicator) {
        let (rank, size) = world.rank_and_size();
        let mut rows = Rows::new(&poisson(5, true), rank, size, Symmetry::PositiveDefinite);
        if rank == size - 1 {
            rows.values[3] = f64::INFINITY;
        }
        let mut x = vec![0.0; rows.len()];
        let mut solver = DistributedSolver::new(world, PetscSettings::default());
        let error = solver.solve(&rows.matrix(0, 0), &vec![1.0; rows.len()], &mut x).unwrap_err().to_string();
        assert!(if rank == size - 1 { error.contains("is inf") } else { error.contains("another rank") }, "{error}");
    }

    fn empty_ranks(world: Communicator) {
        let (rank, size) = world.rank_and_size();
        for engine in PetscEngine::ALL {
            let all = Rows::new(&poisson(5, true), 0, 1, Symmetry::PositiveDefinite);
            let none = Rows::new(&[], 0, 1, Symmetry::PositiveDefinite);
            let rows = if rank + 1 == size { all } else { none };
            let mut solver = DistributedSolver::new(world, settings(engine));
            let (error, _) = solve(&mut solver, &rows, (0, 0)).unwrap();
            assert!(error < 1e-6, "{error:e}");
        }
    }
}
