//! What random bytes are given to.

pub mod targets;
