//! The processes of a run and what they tell each other; one process alone unless `mpirun` started several.
//!
//! [`world`] is the same for the whole life of the program. Every method that all ranks must call together says so; all
//! that is gathered comes in the order of the ranks, so that sums over ranks have the same bits on each of them.

mod agreement;
mod communicator;
#[cfg(feature = "mpi")]
mod mpi_world;

pub use agreement::{defer, deferred, end_after_failure};
pub use communicator::{Communicator, Serial};

use std::sync::OnceLock;

use crate::diagnostics::Result;

static WORLD: OnceLock<Box<dyn Communicator>> = OnceLock::new();

/// All processes of the run.
pub fn world() -> &'static dyn Communicator {
    WORLD.get().map_or(&Serial, AsRef::as_ref)
}

/// Joins the other processes, if the program was started as one of several; keep the value until the end.
///
/// # Errors
/// `Error::System` when several processes were started and this program was built without the feature `mpi`, or when
/// MPI cannot be used.
pub fn start() -> Result<Processes> {
    let count = launched();
    if count <= 1 {
        return Ok(Processes::default());
    }
    #[cfg(feature = "mpi")]
    {
        let (universe, world) = mpi_world::start()?;
        let _ = WORLD.set(Box::new(world));
        Ok(Processes { _universe: Some(universe) })
    }
    #[cfg(not(feature = "mpi"))]
    {
        Err(crate::diagnostics::Error::System(format!(
            "this is one of {count} processes, but the program was built without the feature `mpi`: each would run the \
             whole deck\n    build it with `cargo build --release --features mpi`, or start it without mpirun"
        )))
    }
}

#[cfg(feature = "petsc")]
static PETSC: std::sync::Mutex<Option<zelus_petsc::Session>> = std::sync::Mutex::new(None);

/// The processes as PETSc sees them, which is started when it is not running; collective.
///
/// # Errors
/// [`crate::Error::System`] when PETSc cannot start.
#[cfg(feature = "petsc")]
pub fn petsc() -> Result<zelus_petsc::Communicator> {
    let mut session = PETSC.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let session = match &mut *session {
        Some(session) => session,
        none => {
            let started = zelus_petsc::Session::start();
            none.insert(started.map_err(|error| crate::diagnostics::Error::System(error.to_string()))?)
        }
    };
    Ok(session.world())
}

/// Leaves the other processes when dropped.
#[derive(Default)]
pub struct Processes {
    #[cfg(feature = "mpi")]
    _universe: Option<mpi_world::Universe>,
}

impl Processes {
    /// Whether there are others.
    pub fn are_many(&self) -> bool {
        world().size() > 1
    }
}

#[cfg(feature = "petsc")]
impl Drop for Processes {
    fn drop(&mut self) {
        // PETSc ends before MPI does.
        drop(PETSC.lock().unwrap_or_else(std::sync::PoisonError::into_inner).take());
    }
}

/// Number of processes that mpirun or its like says it has started; 1 without one.
fn launched() -> usize {
    ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE"].iter().find_map(|name| std::env::var(name).ok()?.parse().ok()).unwrap_or(1)
}

/// Processes of the run on the machine of this one, itself included.
fn neighbours() -> usize {
    let names = ["OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS"];
    let count = names.iter().find_map(|name| std::env::var(name).ok()?.parse().ok()).unwrap_or(world().size());
    count.max(1)
}

/// Cores this process may use.
fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Threads a process takes when nothing else is said: the cores it may use, shared by the processes on its machine.
pub fn fair_threads() -> usize {
    if world().size() == 1 { 0 } else { (cores() / neighbours()).max(1) }
}

/// Threads this process may take while those of the other ranks on its machine wait: theirs and its own, as far as there
/// are cores it may use.
pub fn threads_while_others_wait() -> usize {
    let own = rayon::current_num_threads();
    (own * neighbours()).min(cores()).max(own)
}
