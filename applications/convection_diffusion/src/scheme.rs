//! The scheme of heat: elements weigh both ends of a step themselves, so that nothing is left to add.

use zelus_core::register;
use zelus_core::strategies::{Scheme, SchemeEntry, SchemeFactory};

/// Name of the scheme.
pub const SCHEME: &str = "convection_diffusion";

struct ThetaScheme;

impl Scheme for ThetaScheme {
    fn is_static(&self) -> bool {
        true
    }

    /// Temperatures may jump: no element turns inside out by it.
    fn begins_at_prescribed(&self) -> bool {
        true
    }
}

register! { SchemeEntry SCHEME,
    about: "heat: elements contain the rate themselves, by the θ method",
    source: "ρc (T − T₀)/Δt = θ f(T) + (1 − θ) f(T₀)",
    build: SchemeFactory::Implicit(|_| Ok(Box::new(ThetaScheme))),
}
