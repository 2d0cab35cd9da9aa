//! Contact as a participant in the Newton loop: search, pairs, gaps, active set.

mod activation;
mod contact_interaction;
mod step_parameters;

pub use contact_interaction::{ContactInteraction, ContactSettings};
pub use step_parameters::{NormalVariation, StepParameters};
