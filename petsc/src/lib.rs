//! Distributed linear solvers by PETSc: MUMPS' factorisations and multigrid with rigid-body modes.
//!
//! A `Session` keeps PETSc running. A `DistributedMatrix` is the rows this rank owns; a `DistributedSolver` solves with it and keeps
//! reusable data. Everything here is collective: all ranks of the communicator call it, in the same order, and all get the same
//! verdict. Without the feature `petsc` the crate is empty.
#![cfg(feature = "petsc")]

mod engine;
mod ffi;
mod session;
mod matrix;
mod solver;

pub use engine::{PetscEngine, SMALL};
pub use matrix::{DistributedMatrix, RigidModes};
pub use session::{Communicator, Session};
pub use solver::{DistributedSolver, PetscSettings};
