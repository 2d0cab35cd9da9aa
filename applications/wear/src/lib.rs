//! Wear: bodies that slide on each other under pressure lose matter.
//!
//! A [`law`] says how deep a point wears in a step, by the pressure and the way of sliding; `laws` are those there are, one a file.
//! `sliding` finds both on the pairs of mortar contact, [`removal`] takes the worn volume off the nodes of a side, `limits` says when
//! that is too much for the mesh. The process does this after each accepted step. A module uses only those above it in the list below.

pub mod variables;
pub mod law;
mod laws;
mod sliding;
pub mod removal;
mod limits;
mod process;
