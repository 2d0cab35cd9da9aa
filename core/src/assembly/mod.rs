//! From blocks to one linear system: unknowns, sparsity, matrices and right-hand sides.

mod dof_table;

pub use dof_table::{Dof, DofTable, NONE};
