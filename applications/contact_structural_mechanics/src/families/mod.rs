//! The families of contact conditions, one file each, registered by their `mortar_type`.

mod alm_frictional;
mod alm_frictional_pure_slip;
mod alm_frictionless;
mod alm_frictionless_components;
mod mesh_tying;
mod mpc;
mod nitsche_frictional;
mod nitsche_frictionless;
mod penalty_frictional;
mod penalty_frictionless;
mod perturbed_lagrangian_frictionless;
mod shapes;
mod uzawa_frictionless;
