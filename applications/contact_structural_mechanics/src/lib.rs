//! Mortar contact: from the surfaces of a deck to the equations of the bodies that touch.
//!
//! A module uses only those above it in the list below. [`interface`] makes facets of a deck's parts, [`search`] finds the pairs that may touch,
//! [`mortar`] integrates a pair to D, M and the weighted gap, [`kratos`] holds what is only Kratos', [`law`] is the form of a law
//! of one slave node, [`slave_states`] are what is known of slave nodes, [`pairs`] run laws over blocks,
//! [`interaction`] puts all of it into the Newton loop with the active set as a stage. [`laws`] state the laws, one a
//! file, by their `mortar_type`; `processes` and `criteria` are what decks name beside them.

pub mod flags;
pub mod variables;
pub mod node_state;
pub mod mortar;
pub mod kratos;
pub mod friction_law;
pub mod resolution;
pub mod slave_state;
pub mod active_set;
pub mod law;
pub mod interface;
pub mod slave_states;
pub mod slave_status;
pub mod search;
pub mod penalty_adaptation;
pub mod pairs;
pub mod compatibility;
pub mod mpc_kind;
pub mod laws;
pub mod criteria;
mod solver;
pub mod interaction;
mod processes;

pub use processes::{FacingPair, FacingSurfaces};
