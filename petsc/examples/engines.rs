//! Time and memory of the engines for a clamped cube of hexahedra: `mpirun -n 2 engines ENGINE CELLS…`.
//!
//! ENGINE is `mumps_ldlt` or `cg_gamg`, on any number of ranks, or `direct` (this project's) or `faer` (supernodal Cholesky of the
//! crate faer), on one rank and the threads of RAYON_NUM_THREADS. Memory is the peak of each rank beyond the matrix.

#[path = "../tests/support/mod.rs"]
mod support;

use std::fs;
use std::time::Instant;

use faer::prelude::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{MatMut, Par, Side};
use zelus_linear_algebra::{Csr, Engine, Layout, Symmetry, System, create};
use zelus_petsc::{DistributedSolver, PetscEngine, PetscSettings, RigidModes, Session};

use support::{Rows, elasticity};

/// Seconds of ordering and factorisation, seconds of the solve.
type Seconds = [f64; 2];

fn main() {
    let session = Session::start().expect("PETSc starts");
    let world = session.world();
    let (rank, size) = world.rank_and_size();
    let mut words = std::env::args().skip(1);
    let name = words.next().expect("an engine");
    for cells in words.map(|word| word.parse().expect("a number of cells")) {
        let (entries, modes) = elasticity(cells, true);
        let mut rows = Rows::new(&entries, rank, size, Symmetry::PositiveDefinite);
        drop(entries);
        let owned = rows.first..rows.first + rows.len();
        let nodes = nodes(&modes);
        rows.modes = Some(RigidModes {
            dimension: 3,
            coordinates: modes.coordinates[owned.clone()].to_vec(),
            components: modes.components[owned].to_vec(),
        });
        let rhs = rows.rhs();
        let mut x = vec![0.0; rows.len()];
        fs::write("/proc/self/clear_refs", "5").expect("the peak of memory is forgotten");
        let before = (memory("VmRSS:"), processor());
        let (seconds, residual) = match name.as_str() {
            "direct" => direct(&rows, nodes, &rhs, &mut x),
            "faer" => supernodal(&rows, &rhs, &mut x),
            _ => {
                let engine = PetscEngine::ALL.into_iter().find(|engine| engine.name() == name).expect("an engine");
                let options = std::env::var("ZELUS_PETSC_OPTIONS").unwrap_or_default();
                let settings = PetscSettings { engine: Some(engine), options, ..PetscSettings::default() };
                let mut solver = DistributedSolver::new(world, settings);
                let report = solver.solve(&rows.matrix(0, 0), &rhs, &mut x).expect("an answer");
                ([report.seconds_numeric, report.seconds_solve], report.relative_residual)
            }
        };
        println!(
            "{name}, rank {rank} of {size}: {} equations, set up {:.2} s, solve {:.2} s, processor {:.1} s, memory {:.0} MB, residual \
             {residual:.1e}, error {:.1e}",
            rows.all,
            seconds[0],
            seconds[1],
            processor() - before.1,
            (memory("VmHWM:") - before.0) / 1e3,
            rows.error(&x)
        );
    }
}

/// Kilobytes of this process.
fn memory(of: &str) -> f64 {
    let status = fs::read_to_string("/proc/self/status").expect("Linux");
    let line = status.lines().find_map(|line| line.strip_prefix(of)).expect("a line of the status");
    line.split_whitespace().next().and_then(|number| number.parse().ok()).expect("kilobytes")
}

/// Seconds that the threads of this process have run.
fn processor() -> f64 {
    let status = fs::read_to_string("/proc/self/stat").expect("Linux");
    let after_name = status.rsplit(')').next().expect("a name in brackets");
    // Fields 14 and 15 of the file, in hundredths of a second; two come before the bracket.
    after_name.split_whitespace().skip(11).take(2).map(|ticks| ticks.parse::<f64>().expect("a number") / 100.0).sum()
}

/// Node of each equation: equations of one node follow each other.
fn nodes(modes: &RigidModes) -> Vec<u32> {
    let mut node = 0;
    let same = |at: usize| at > 0 && modes.coordinates[at] == modes.coordinates[at - 1];
    let of_equation = |at: usize| {
        node += u32::from(at > 0 && !same(at));
        node
    };
    (0..modes.coordinates.len()).map(of_equation).collect()
}

fn direct(rows: &Rows, node: Vec<u32>, rhs: &[f64], x: &mut [f64]) -> (Seconds, f64) {
    assert_eq!(rows.len(), rows.all, "one rank");
    let columns = rows.columns.iter().map(|&column| column as u32).collect();
    let mut matrix = Csr::from_sorted_pattern(rows.starts.clone(), columns);
    matrix.values.copy_from_slice(&rows.values);
    let layout = Layout { node, multiplier: vec![false; rows.all], ..Layout::default() };
    let system = System::bulk(&layout, &matrix, Symmetry::PositiveDefinite);
    let report = create(Engine::default()).solve(&system, rhs, x).expect("an answer");
    ([report.seconds_symbolic + report.seconds_numeric, report.seconds_solve], report.relative_residual)
}

fn supernodal(rows: &Rows, rhs: &[f64], x: &mut [f64]) -> (Seconds, f64) {
    assert_eq!(rows.len(), rows.all, "one rank");
    faer::set_global_parallelism(Par::rayon(0));
    let n = rows.all;
    let start = Instant::now();
    let columns: Vec<usize> = rows.columns.iter().map(|&column| column as usize).collect();
    let pattern = SymbolicSparseColMatRef::new_checked(n, n, &rows.starts, None, &columns);
    let symbolic = SymbolicLlt::try_new(pattern, Side::Lower).expect("memory");
    let matrix = SparseColMatRef::new(pattern, &rows.values);
    let factor = Llt::try_new_with_symbolic(symbolic, matrix, Side::Lower).expect("positive definite");
    let set_up = start.elapsed().as_secs_f64();
    let start = Instant::now();
    x.copy_from_slice(rhs);
    factor.solve_in_place(MatMut::from_column_major_slice_mut(x, n, 1));
    let solve = start.elapsed().as_secs_f64();
    let norm = |of: &dyn Fn(usize) -> f64| (0..n).map(|i| of(i).powi(2)).sum::<f64>().sqrt();
    let product =
        |i: usize| (rows.starts[i]..rows.starts[i + 1]).map(|at| rows.values[at] * x[columns[at]]).sum::<f64>();
    ([set_up, solve], norm(&|i| rhs[i] - product(i)) / norm(&|i| rhs[i]))
}
