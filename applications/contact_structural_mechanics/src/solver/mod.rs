//! What contact adds to the solver's settings.

mod contact_settings;

pub(crate) use contact_settings::{COMPUTE_DYNAMIC_FACTOR, ENSURE_CONTACT, SIMPLIFIED_SEMI_SMOOTH_NEWTON};
