//! Laws of soft contact: how deep surfaces go into each other under a pressure.

use serde::{Deserialize, Serialize};
use zelus_core::Result;
use zelus_core::parameters::Settings;
use zelus_core::registered_kind;

/// Overclosure under a pressure, with its derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overclosure {
    /// Depth, negative where surfaces press before they touch (length).
    pub depth: f64,
    /// Derivative of the depth by the pressure, above 0 (length by stress).
    pub compliance: f64,
}

/// A law of soft contact.
pub trait OverclosureLaw: Send + Sync {
    /// The overclosure under a pressure from 0, positive in compression.
    fn overclosure(&self, pressure: f64) -> Overclosure;
}

/// Makes a law from its settings, defaults filled in.
pub type MakeOverclosureLaw = fn(&Settings) -> Result<Box<dyn OverclosureLaw>>;

registered_kind! {
    /// A law of soft contact, by the name of `law` in `pressure_overclosure`.
    pub struct OverclosureLawEntry("overclosure_law", "unknown-name") {
        build: MakeOverclosureLaw;
    }
}

/// Tangent of a law of soft contact at the pressure of a slave node.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SoftTangent {
    /// Derivative of the depth by the pressure (length by stress).
    pub compliance: f64,
    /// Pressure at which the tangent has no depth, negative in compression.
    pub pressure_at_rest: f64,
    /// Depth at which contact begins, 0 or negative (length).
    pub begin: f64,
}

impl SoftTangent {
    /// The tangent at a pressure from 0, positive in compression.
    pub fn of(law: &dyn OverclosureLaw, pressure: f64) -> Self {
        let Overclosure { depth, compliance } = law.overclosure(pressure);
        let begin = law.overclosure(0.0).depth;
        Self { compliance, pressure_at_rest: depth / compliance - pressure, begin }
    }
}
