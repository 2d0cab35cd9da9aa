//! Mortar contact: from the surfaces of a deck to the equations of the bodies that touch.
//!
//! A module uses only those above it in the list below.
//!
//! - [`mortar`] integrates a pair of facets to D, M and the weighted gap; [`kratos`] reproduces Kratos where a deck asks for it.
//! - [`law`] is the form of contact and friction laws of one slave node, with the rules of its active set.
//! - [`interface`] makes facets, patches and slave nodes of the parts of a deck; [`slave_nodes`] holds the states of slave nodes.
//! - [`search`] finds pairs that may touch, [`pairs`] evaluates laws over blocks of pairs, [`laws`] are the laws, one a file.
//! - [`criteria`], `solver` and `processes` read the settings of decks.
//! - [`friction`], [`adaptation`], [`settings`], `active_set`, `pairing` and `safeguards` are the stages of contact in a step.
//! - [`interaction`] puts them into the Newton loop; [`tying`] are ties by multipliers, [`mpc`] contact and ties by constraints.

pub mod flags;
pub mod variables;
pub mod mortar;
pub mod kratos;
pub mod tolerances;
pub mod law;
pub mod interface;
pub mod slave_nodes;
pub mod search;
pub mod pairs;
pub mod compatibility;
pub mod laws;
pub mod criteria;
mod solver;
mod results;
pub mod friction;
pub mod adaptation;
pub mod settings;
mod active_set;
mod pairing;
mod safeguards;
pub mod tying;
pub mod mpc;
pub mod interaction;
mod processes;

pub use processes::{FacingPair, FacingSurfaces};
