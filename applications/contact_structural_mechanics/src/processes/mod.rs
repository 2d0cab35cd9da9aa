//! The processes of contact.

mod alm_contact_process;
