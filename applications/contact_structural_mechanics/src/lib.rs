//! Mortar contact.
pub mod mortar;
pub mod formulations;
pub mod active_set;
pub mod penalty_adaptation;
