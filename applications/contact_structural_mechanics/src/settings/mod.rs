//! Settings of contact by a deck, and the numbers that bodies add to them.

mod calibration;
mod contact_settings;
mod setup;

pub use contact_settings::{ContactSettings, SurfaceSettings};
pub(crate) use setup::Setup;
