//! What random bytes are given to.

pub mod forge;
pub mod targets;
