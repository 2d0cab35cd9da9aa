//! Ties of meshes that do not match, by multipliers.

mod tying_block;
mod tying_interaction;

pub use tying_block::{TyingBlock, TyingRequest};
pub use tying_interaction::{TyingInteraction, TyingSettings};
