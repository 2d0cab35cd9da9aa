//! Behaviour of contact that only reproduces Kratos, behind the settings whose defaults `--like kratos` changes.
//!
//! [`DEVIATIONS`] names each with its source; `tests/contact/like_kratos.rs` switches each off and states the change. Where one is a
//! formula of its own it stands here ([`FlatMaster`], [`FirstIterateTangent`], [`PenaltyUnit`]); the others are values of settings
//! whose other value is the default.

mod deviations;
mod first_iterate;
mod flat_master;
mod penalty_unit;

pub use deviations::{DEVIATIONS, Deviation};
pub use first_iterate::FirstIterateTangent;
pub use flat_master::FlatMaster;
pub use penalty_unit::PenaltyUnit;
