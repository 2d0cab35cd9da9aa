//! The families of contact conditions, one file each, registered by their `mortar_type`.
//!
//! A file states a family's multipliers, what it remembers, its residual, the rule of its active set and its names. Another crate
//! adds one in the same way.

pub mod alm_frictional;
pub mod alm_frictionless;
pub mod alm_frictionless_components;
mod mesh_tying;
mod mpc;
mod nitsche;
pub mod penalty_by_node;
pub mod penalty_frictional;
pub mod penalty_frictionless;
mod perturbed_lagrangian_frictionless;
mod register;
mod uzawa_frictionless;
