//! The solution of one step: time scheme, Newton's iteration, convergence criteria.
//!
//! A [`Scheme`] gives the inertia terms and the rates from displacements; a [`ConvergenceCriterion`] judges and changes nothing;
//! [`NewtonRaphson`] iterates, [`ExplicitStrategy`] does without. The active set of contact is a stage of each iteration, see
//! [`crate::entities::ActiveSet::after_update`].

mod arc_length;
mod balance;
mod body_balance;
mod bdf_scheme;
mod bossak_scheme;
mod builder;
mod central_differences;
mod condensing;
mod convergence_rate;
mod criterion;
mod critical_step;
mod displacement_criterion;
mod energy_balance;
mod explicit;
mod explicit_energy;
mod local_to_global;
mod distributed_rows;
mod root_gather;
mod generalized_alpha_scheme;
mod omitted_fields;
mod line_search;
mod linear_solve;
mod linear_solvers;
mod dof_name;
mod mass_scaling;
mod measure;
mod memory;
mod newton;
mod newton_strategies;
#[cfg(feature = "petsc")]
mod petsc_condensation;
#[cfg(feature = "petsc")]
mod petsc_rows;
mod phases;
mod pseudo_static_scheme;
mod reactions;
mod records;
mod residual_criterion;
mod scheme;
mod strategy;
mod strategy_entry;
mod location;

pub use arc_length::{ArcLength, ArcLengthSettings};
pub use balance::{Balance, BalanceTerms, Energies, Flows, PairBalance, SupportReaction, UnknownBalance};
pub use bdf_scheme::BdfScheme;
pub use body_balance::BodyBalance;
pub use bossak_scheme::BossakScheme;
pub use builder::{BuilderAction, BuilderEntry};
pub use central_differences::CentralDifferences;
pub(crate) use condensing::multipliers;
pub use condensing::{OFF_NODE_TOLERANCE, ZERO_ROW_TOLERANCE};
pub use criterion::{
    Block, ConvergenceCheck, ConvergenceCriterion, CriterionEntry, CriterionFactory, CriterionRequest, Measures, Norm,
    Verdict, both, either, is_last_digit, is_round_off,
};
pub use critical_step::critical_step;
pub use explicit::{CRITICAL_STEP, ExplicitSettings, ExplicitStrategy};
pub use generalized_alpha_scheme::GeneralizedAlphaScheme;
pub use line_search::LineSearch;
pub use linear_solvers::{LinearSolverEntry, LinearSolverFactory, LinearSolverRequest, PreconditionerEntry};
pub(crate) use linear_solvers::{
    frugal as frugal_linear_solver, make as make_linear_solver, tolerance as linear_tolerance, unknowns_of_all,
};
pub(crate) use location::{body_in_words, body_of, location};
pub use measure::{Form, Measure, Tolerance};
pub(crate) use newton::ONLY_CONTACT_RESTRAINS;
pub use newton::{ENERGY_OF_MOTION, NewtonRaphson, NewtonSettings};
pub use phases::Phases;
pub use pseudo_static_scheme::PseudoStaticScheme;
pub use reactions::write_reactions;
pub use records::{IterationRecord, Monitor, Plan, Silent, StepRecord};
pub use scheme::{Scheme, SchemeEntry, SchemeFactory, SchemeRequest, StaticScheme};
pub use strategy::{Linearized, SolutionStrategy, accept, recorded};
pub use strategy_entry::{StrategyEntry, StrategyFactory, StrategyRequest};
