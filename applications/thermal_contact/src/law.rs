//! How much heat passes between two bodies at a point.

use zelus_core::Result;
use zelus_core::parameters::Settings;
use zelus_core::registered_kind;
use zelus_core::scalar::Dual;

/// A number with its derivatives by the temperatures of slave and master.
pub type ByTemperatures = Dual<2>;

/// How two bodies meet at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactPoint {
    /// By which they press on each other (force per area), 0 where they do not.
    pub pressure: f64,
    /// Between them (length), 0 where they touch.
    pub gap: f64,
    /// Whether they touch.
    pub touches: bool,
    /// Areas of slave and master in the area that conductance counts by, the mean over the way between them: 1 between planes.
    pub areas: [f64; 2],
}

/// The conductance of a contact.
pub trait ConductanceLaw: Send + Sync {
    /// Heat by mean area and difference of temperature (power per area and temperature) at the temperatures of slave and master.
    fn conductance(&self, contact: &ContactPoint, temperatures: [ByTemperatures; 2]) -> ByTemperatures;

    /// Whether heat passes without touch.
    fn acts_apart(&self) -> bool {
        false
    }
}

/// Makes a law from its settings, defaults filled in.
pub type MakeLaw = fn(&Settings) -> Result<Box<dyn ConductanceLaw>>;

registered_kind! {
    /// A law of conductance that decks name.
    pub struct ContactConductanceEntry("contact_conductance", "unknown-name") {
        build: MakeLaw;
    }
}
