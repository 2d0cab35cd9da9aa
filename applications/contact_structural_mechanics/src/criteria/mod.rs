//! Convergence criteria of contact: displacements and multipliers are measured apart.
//!
//! Every tolerance is of a norm. Kratos' own criteria of these names compare sums of squares, so that a tolerance of 1e-4 leaves 1e-2
//! on the norm there. Beside them, every iteration must leave the active set unchanged.

mod contact_criterion;
mod frictional_criterion;

pub use contact_criterion::ContactCriterion;
pub use frictional_criterion::FrictionalCriterion;
