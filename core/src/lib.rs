//! The framework of zelus: models, parameters, registries, assembly and strategies; it knows no physics.
//!
//! Read the modules in the order below: each uses only those above it, and data flows the same way, from the words of a deck to the
//! numbers on disk. Objects that decks name are in [`registry`]; objects that compute are in [`entities`].

pub mod names;
pub mod diagnostics;
pub mod communication;
pub mod parameters;
pub mod scalar;
pub mod vector3;
pub mod geometry;
pub mod registry;
pub mod model;
pub mod entities;
pub mod io;
pub mod assembly;
pub mod strategies;
pub mod processes;
pub mod modelers;
pub mod partition;
pub mod analysis;

pub use diagnostics::{Error, Result};
#[doc(hidden)]
pub use inventory;
pub use zelus_linear_algebra::{
    BlockPivoting, Complementarity, Components, Exchange, State, StateMapper, Unknowns, WrongState, packed, parallel,
    stored_as_bytes,
};
