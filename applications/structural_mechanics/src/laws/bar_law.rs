//! Laws along a bar: one stress from one strain.

use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;

use super::expansion::Expansion;

/// Stress along a bar, positive in tension.
pub trait BarLaw: Send + Sync {
    /// Stress at a strain where `prestress` acts without strain, its derivative by the strain, and the history after a step that ends
    /// so. The history is 0 before the first step.
    fn response(&self, strain: f64, prestress: f64, remembered: [f64; 2]) -> (f64, f64, [f64; 2]);

    /// Whether the stress is a constant times the strain.
    fn is_linear(&self) -> bool {
        false
    }

    /// How it expands, if it does: [`BarLaw::response`] is then to the strain without the thermal one.
    fn expansion(&self) -> Option<&Expansion> {
        None
    }
}

/// Makes a law of bars from the properties.
pub type MakeBarLaw = fn(&Properties) -> Result<Box<dyn BarLaw>>;
