//! The solution of one step: time scheme, Newton's iteration, convergence criteria.
//!
//! A [`Scheme`] says what inertia adds and how rates follow displacements; a [`ConvergenceCriterion`] judges and changes
//! nothing; [`NewtonRaphson`] iterates. The active set of contact is a stage of each iteration, see
//! [`crate::entities::Interaction::after_update`].

mod bossak_scheme;
mod criterion;
mod displacement_criterion;
mod linear_solve;
mod newton;
mod records;
mod residual_criterion;
mod scheme;

pub use bossak_scheme::BossakScheme;
pub use criterion::{
    Block, Check, ConvergenceCriterion, CriterionFactory, CriterionRequest, Measures, Verdict, both, either,
    is_round_off, norm,
};
pub use displacement_criterion::DisplacementCriterion;
pub use newton::{NewtonRaphson, NewtonSettings};
pub use records::{IterationRecord, Monitor, Silent, StepRecord};
pub use residual_criterion::ResidualCriterion;
pub use scheme::{Scheme, SchemeFactory, SchemeRequest, StaticScheme};
