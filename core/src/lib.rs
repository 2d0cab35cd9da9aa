//! The framework of zelus: models, parameters, registries, assembly and strategies; it knows no physics.
//!
//! Read the modules in the order below: each uses only those above it, and data flows the same way, from the words of a
//! deck to the numbers on disk. What is found by name is in [`registry`]; what computes is in [`entities`].

pub mod assembly;
pub mod diagnostics;
pub mod entities;
pub mod geometry;
pub mod io;
pub mod model;
pub mod parameters;
pub mod registry;
pub mod scalar;
pub mod vector3;

pub use diagnostics::{Error, Result};
#[doc(hidden)]
pub use inventory;
