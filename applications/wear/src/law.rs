//! How deep a point wears.

use zelus_core::Result;
use zelus_core::parameters::Settings;
use zelus_core::registered_kind;

/// How a point has been rubbed in a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlidingStep {
    /// By which the bodies press on each other (force per area), above 0.
    pub pressure: f64,
    /// How far they have slid on each other (length), from 0.
    pub slip: f64,
}

/// The wear of one of two bodies.
pub trait WearLaw: Send + Sync {
    /// Depth that a point of the body has lost (length), from 0.
    fn depth(&self, sliding: &SlidingStep) -> f64;
}

/// Makes a law from its settings, defaults filled in.
pub type MakeLaw = fn(&Settings) -> Result<Box<dyn WearLaw>>;

registered_kind! {
    /// A law of wear that decks name.
    pub struct WearLawEntry("wear_law", "unknown-name") {
        build: MakeLaw;
    }
}
