//! Settings of contact at the solver.

mod contact_solver_settings;

pub use contact_solver_settings::ContactSolverSettings;
pub(crate) use contact_solver_settings::{IMPACT_NUMBERS, marks_of_words};
