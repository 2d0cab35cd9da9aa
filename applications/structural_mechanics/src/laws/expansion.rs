//! Thermal expansion, the same in all directions.

use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;

use super::quantity::Quantity;
use crate::tensor::pairs;

/// α, the secant from T₀, which follows a table over TEMPERATURE where there is one; and T₀.
#[derive(Debug, Clone, PartialEq)]
pub struct Expansion {
    coefficient: Quantity,
    reference: f64,
}

/// Constants that laws with expansion take.
pub const CONSTANTS: &[&str] = &["THERMAL_EXPANSION_COEFFICIENT", "REFERENCE_TEMPERATURE"];

impl Expansion {
    /// From THERMAL_EXPANSION_COEFFICIENT and REFERENCE_TEMPERATURE.
    ///
    /// # Errors
    /// Constants that are missing.
    pub fn of(properties: &Properties) -> Result<Self> {
        Ok(Self {
            coefficient: Quantity::of(properties, "THERMAL_EXPANSION_COEFFICIENT")?,
            reference: properties.require("REFERENCE_TEMPERATURE")?,
        })
    }

    /// T₀.
    pub fn reference(&self) -> f64 {
        self.reference
    }

    /// α(T) (T − T₀).
    pub fn strain(&self, temperature: f64) -> f64 {
        self.coefficient.at(temperature) * (temperature - self.reference)
    }
}

/// A strain without a part that is the same in all directions.
pub fn without<const S: usize>(mut strain: [f64; S], part: f64) -> [f64; S] {
    for (strain, (p, q)) in strain.iter_mut().zip(pairs::<S>()) {
        *strain -= if p == q { part } else { 0.0 };
    }
    strain
}

/// The part that plane strain, without its component across the plane, and all other forms have of a thermal strain: the constraint
/// across the plane adds ν times the strain to the others.
pub fn in_form<const S: usize>(thermal: f64, poisson: f64, stress_free: bool) -> f64 {
    if S == 3 && !stress_free { (1.0 + poisson) * thermal } else { thermal }
}
