//! Active set: the slave nodes in contact at step start, their update in every iteration, cycles, and constrained multipliers.
//!
//! The rules of single nodes are in [`law::rules`](crate::law::rules).

pub(crate) mod activation;
mod cycling;
mod decision;
pub(crate) mod forced_points;
mod holding;
mod joint_decision;
mod measured_resolution;
mod set_stage;
mod sliding;

pub(crate) use activation::ActivationCriterion;
pub(crate) use decision::Rules;
pub(crate) use holding::{FacetsOfPair, Holding};
pub(crate) use measured_resolution::{resolution, resolved_length};
pub(crate) use set_stage::SetStage;
#[cfg(test)]
pub(crate) use sliding::find_tangents;
