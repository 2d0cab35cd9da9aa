//! Mortar contact.
pub mod mortar;
pub mod formulations;
