//! Numbers of contact that follow the solution: adapted penalties, ramps of penalty and friction, Uzawa pressures.

mod adaptation_stage;
mod stable_penalty;
mod friction_ramp;
mod penalty_adaptation;
mod penalty_ramp;
mod uzawa;

pub use adaptation_stage::{AdaptationSettings, ExplicitPenalty};
pub(crate) use friction_ramp::FrictionRamp;
pub use penalty_adaptation::{
    Growth, PenaltyAdaptation, PenaltyAdaptationEntry, PenaltyRule, adapted_augmented_lagrangian, adapted_penalty,
    dynamic_factor, printed_augmented_lagrangian,
};
pub(crate) use penalty_ramp::PenaltyRamp;
pub(crate) use stable_penalty::StablePenalty;
pub(crate) use uzawa::Uzawa;
pub use uzawa::UzawaSettings;
