//! The ranks of a run and their communication; one rank alone unless `mpirun` started several.
//!
//! [`Ranks`] are passed on with the shared data: a model and its parts carry them, and so do objects made from these. Nothing is
//! global, so runs of different ranks, or of one alone, stand beside each other in one program.
//! Every method that all ranks must call together says so; all that is gathered comes in the order of the ranks, so that
//! sums over ranks have the same bits on each of them.

mod agreement;
mod communicator;
#[cfg(feature = "mpi")]
mod mpi_world;
mod ranks;
mod values;

pub use communicator::Communicator;
pub use ranks::Ranks;

use zelus_linear_algebra::parallel;

use crate::diagnostics::Result;

/// Joins the other ranks, if the program was started as one of several; they part when the last clone is dropped.
///
/// # Errors
/// `Error::System` when several ranks were started and this program was built without the feature `mpi`, or when MPI cannot be used, as
/// when it was joined before.
pub fn join() -> Result<Ranks> {
    let count = launched();
    if count <= 1 {
        return Ok(Ranks::default());
    }
    #[cfg(feature = "mpi")]
    {
        mpi_world::start().map(Ranks::new)
    }
    #[cfg(not(feature = "mpi"))]
    {
        Err(crate::diagnostics::Error::System(format!(
            "this is one of {count} processes, but the program was built without the feature `mpi`: each would run the \
             whole deck\n    build it with `cargo build --release --features mpi`, or start it without mpirun"
        )))
    }
}

fn number_of(names: &[&str]) -> Option<usize> {
    names.iter().find_map(|name| std::env::var(name).ok()?.parse().ok())
}

/// Number of ranks that mpirun or its like has started; 1 without one.
fn launched() -> usize {
    number_of(&["OMPI_COMM_WORLD_SIZE", "PMI_SIZE"]).unwrap_or(1)
}

/// Ranks that were started together on the machine of this one, itself included.
fn neighbours() -> usize {
    number_of(&["OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS"]).unwrap_or_else(launched).max(1)
}

/// Cores this process may use.
pub(crate) fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Threads a process takes when nothing else is said: the cores it may use, shared by the ranks on its machine; 0, as
/// many as there are, where it was started alone.
pub fn fair_threads() -> usize {
    if launched() == 1 { 0 } else { (cores() / neighbours()).max(1) }
}

/// Threads this process may take while those of the other ranks on its machine wait: theirs and its own, as far as there
/// are cores it may use.
pub fn threads_while_others_wait() -> usize {
    let own = parallel::threads();
    (own * neighbours()).min(cores()).max(own)
}
