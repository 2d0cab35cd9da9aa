//! The families of contact conditions, one file each, registered by their `mortar_type`.

mod alm_frictionless;
mod alm_frictionless_components;
mod shapes;
