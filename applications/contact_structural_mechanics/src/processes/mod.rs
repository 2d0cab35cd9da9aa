//! The processes of contact.

mod alm_contact_process;
mod interface_settings;
mod mesh_tying_process;
mod mpc_contact_process;
mod simple_mortar_mapper_process;
mod penalty_contact_process;
