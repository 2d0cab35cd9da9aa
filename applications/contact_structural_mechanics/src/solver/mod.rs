//! What contact adds to the solver's settings.

mod contact_settings;
