//! The processes of contact.

mod alm_contact_process;
mod alm_variables_calculation_process;
mod explicit_penalty_contact_process;
mod facing_surfaces;
mod friction_settings;
mod initial_clearance_process;
mod interaction_process;
mod interface_settings;
mod mesh_tying_process;
mod mpc_contact_process;
mod simple_mortar_mapper_process;
mod nitsche_contact_process;
mod penalty_contact_process;
mod perturbed_lagrangian_contact_process;
mod touching;
mod uzawa_contact_process;

pub use facing_surfaces::{FacingPair, FacingSurfaces};
