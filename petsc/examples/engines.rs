//! How long the engines take on a clamped cube: `mpirun -n 2 engines CELLS…`.

#[path = "../tests/support/mod.rs"]
mod support;

use zelus_linear_algebra::Symmetry;
use zelus_petsc::{DistributedSolver, PetscEngine, PetscSettings, RigidModes, Session};

use support::{Rows, elasticity};

fn main() {
    let session = Session::start().expect("PETSc starts");
    let world = session.world();
    let (rank, size) = world.rank_and_size();
    let options = std::env::var("ZELUS_PETSC_OPTIONS").unwrap_or_default();
    for cells in std::env::args().skip(1).filter_map(|word| word.parse().ok()) {
        let (entries, modes) = elasticity(cells, true);
        let mut rows = Rows::new(&entries, rank, size, Symmetry::PositiveDefinite);
        let owned = rows.first..rows.first + rows.len();
        rows.modes = Some(RigidModes {
            dimension: 3,
            coordinates: modes.coordinates[owned.clone()].to_vec(),
            components: modes.components[owned].to_vec(),
        });
        for engine in [PetscEngine::MumpsLdlt, PetscEngine::CgGamg] {
            let settings = PetscSettings { engine: Some(engine), options: options.clone(), ..PetscSettings::default() };
            let mut solver = DistributedSolver::new(world, settings);
            let mut x = vec![0.0; rows.len()];
            let report = solver.solve(&rows.matrix(0, 0), &rows.rhs(), &mut x).expect("an answer");
            if rank == 0 {
                println!(
                    "{size} ranks, {} equations, {}: set up {:.2} s, solve {:.2} s, {} iterations, residual {:.1e}, \
                     error {:.1e}",
                    rows.all,
                    engine.name(),
                    report.seconds_numeric,
                    report.seconds_solve,
                    report.iterations,
                    report.relative_residual,
                    rows.error(&x)
                );
            }
        }
    }
}
