//! Mortar contact.
pub mod mortar;
