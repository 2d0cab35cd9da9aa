//! The processes of contact.

mod alm_contact_process;
mod penalty_contact_process;
