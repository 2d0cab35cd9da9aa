//! Active set: the slave nodes in contact at step start, their update in every iteration, cycles, and constrained multipliers.
//!
//! The rules of single nodes are in [`law::rules`](crate::law::rules).

pub(crate) mod activation;
mod cycling;
mod decision;
pub(crate) mod forced_points;
mod supported_nodes;
pub(crate) mod corner_nodes;
mod joint_decision;
mod measured_tolerances;
mod active_set_update;
mod sliding;

pub(crate) use activation::ActivationCriterion;
pub(crate) use active_set_update::ActiveSetUpdate;
pub(crate) use decision::Rules;
pub(crate) use measured_tolerances::{length_tolerance, tolerances};
#[cfg(test)]
pub(crate) use sliding::find_tangents;
pub(crate) use supported_nodes::{FacetsOfPair, SupportedNodes};
