//! Conditions: heat through the boundary.

mod face;

pub use face::{DATA, Face};
