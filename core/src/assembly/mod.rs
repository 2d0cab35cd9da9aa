//! From blocks to one linear system: unknowns, sparsity, matrices and right-hand sides.

mod assembler;
mod bulk_matrix;
mod corner_interpolation;
mod distribution;
mod dof_table;
mod equations;
mod group_matrix;
mod local;
mod near_null_space;
mod neighbours;
mod nodal_vectors;
mod numbering;
mod runaway_bound;
mod redistribution;
mod rows;
mod supports;
mod system;

pub use assembler::{
    Assembler, AssemblerState, AssemblySeconds, ForceKinds, Inertia, PairForce, ScaledMass, WholeSystem,
    damped_by_properties, strongest_damping,
};
pub use distribution::Distribution;
pub use dof_table::{Dof, DofTable, NONE};
pub use equations::{Equations, impose_constraints};
pub use near_null_space::{DofPosition, near_null_space, near_null_space_of_all};
pub use nodal_vectors::nodal_vectors;
pub use numbering::Numbering;
pub use runaway_bound::runaway_bound;
pub use system::System;
