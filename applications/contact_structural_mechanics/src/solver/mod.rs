//! What contact adds to the solver's settings.

mod contact_settings;

pub(crate) use contact_settings::{
    ADJUST_INITIAL, ADJUST_TOLERANCE, AVERAGED_EDGES, COMPUTE_DYNAMIC_FACTOR, DELTA_TIME_FACTOR, ENSURE_CONTACT,
    IMPACT_TOLERANCE, KEEP_MASS, LARGEST_ENERGY_GAIN, LARGEST_PENETRATION, feature_angle,
};
