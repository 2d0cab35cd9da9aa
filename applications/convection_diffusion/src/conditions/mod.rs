//! Conditions: what passes through the boundary.

mod face;

pub use face::{DATA, Face};
