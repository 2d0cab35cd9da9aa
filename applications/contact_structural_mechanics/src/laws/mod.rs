//! Contact laws, one formula a file, each registered with its formulations by their `mortar_type`.
//!
//! Laws of friction are in [`friction`], those of soft contact in `overclosure`, those of bonds in [`cohesive`]. A file states a law's multiplier, its measure of slip, its force and rows at a slave node, the rule of its active set and its
//! names. Another crate adds one in the same way.

pub mod alm_frictional;
pub mod alm_frictionless;
pub mod alm_frictionless_components;
pub mod bonded;
pub mod cohesive;
pub mod friction;
mod mesh_tying_formulation;
mod mpc;
mod nitsche_formulation;
mod overclosure;
pub mod penalty_by_node;
pub mod penalty_frictional;
pub mod penalty_frictionless;
mod perturbed_lagrangian_frictionless;
mod register;
mod uzawa_frictionless;
