//! Contact as a participant in the Newton loop: search, pairs, gaps, active set.

mod activation;
mod adaptation;
mod bearable_penalty;
mod calibration;
mod contact_interaction;
mod contact_settings;
mod coverage;
mod cycling;
mod edges;
mod friction;
mod friction_ramp;
mod holding;
mod impact;
mod late_pairs;
mod mpc_interaction;
mod mpc_relation;
mod pairing;
mod penalty_ramp;
mod points;
mod reach;
mod slider_forces;
mod sliding;
mod step_parameters;
#[cfg(test)]
mod tangent_tests;
mod tying_interaction;
mod uzawa;
mod work;

pub use adaptation::{AdaptationSettings, ExplicitPenalty};
pub use contact_interaction::ContactInteraction;
pub use contact_settings::ContactSettings;
pub use friction::FrictionSettings;
pub use mpc_interaction::{MpcInteraction, MpcKind, MpcSettings};
pub use mpc_relation::Weights;
pub use step_parameters::{NormalVariation, StepParameters};
pub use tying_interaction::{TyingInteraction, TyingSettings};
pub use uzawa::UzawaSettings;
