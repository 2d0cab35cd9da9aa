//! What contact adds to the solver's settings.

mod contact_solver_settings;

pub use contact_solver_settings::ContactSolverSettings;
