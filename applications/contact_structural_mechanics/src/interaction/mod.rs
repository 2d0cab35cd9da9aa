//! Contact as a participant in the Newton loop: steps, iterations, and the loops around them.

mod contact_interaction;
mod contact_state;
mod outer_loops;
#[cfg(test)]
mod tangent_tests;

pub use contact_interaction::ContactInteraction;
