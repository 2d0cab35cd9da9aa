//! Mooney's and Rivlin's energy, with two or five terms.
//!
//! W = C₁₀ (Ī₁ − 3) + C₀₁ (Ī₂ − 3) + C₂₀ (Ī₁ − 3)² + C₁₁ (Ī₁ − 3)(Ī₂ − 3) + C₀₂ (Ī₂ − 3)²; the shear modulus at rest is
//! 2 (C₁₀ + C₀₁).

use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;

use super::fit::{Constants, FitStart};
use super::rubber::{Energy, register_rubber};
use super::strain_energy::{EnergyDerivatives, InvariantEnergy};

/// Constants of the energy.
#[derive(Debug, Clone, PartialEq)]
pub struct MooneyRivlin {
    /// C₁₀ and C₀₁.
    pub linear: [f64; 2],
    /// C₂₀, C₁₁ and C₀₂.
    pub quadratic: [f64; 3],
}

impl InvariantEnergy for MooneyRivlin {
    fn derivatives(&self, invariants: [f64; 3]) -> EnergyDerivatives {
        let ([x, y, _], [c20, c11, c02]) = (invariants.map(|own| own - 3.0), self.quadratic);
        EnergyDerivatives {
            value: self.linear[0] * x + self.linear[1] * y + c20 * x * x + c11 * x * y + c02 * y * y,
            first: [self.linear[0] + 2.0 * c20 * x + c11 * y, self.linear[1] + c11 * x + 2.0 * c02 * y, 0.0],
            second: [[2.0 * c20, c11, 0.0], [c11, 2.0 * c02, 0.0], [0.0; 3]],
        }
    }
}

/// # Errors
/// Constants that are missing.
fn energy(properties: &Properties) -> Result<Energy> {
    let number = |name: &str| properties.number(name).unwrap_or(0.0);
    Ok(Energy::Invariants(Box::new(MooneyRivlin {
        linear: [properties.require("C10")?, properties.require("C01")?],
        quadratic: ["C20", "C11", "C02"].map(number),
    })))
}

/// Two terms, or five.
fn starts(start: &FitStart) -> Vec<Constants> {
    let mut constants: Constants = vec![("C10", vec![0.4 * start.modulus]), ("C01", vec![0.1 * start.modulus])];
    match start.terms {
        None | Some(2) => {}
        Some(5) => constants.extend(["C20", "C11", "C02"].map(|name| (name, vec![0.0]))),
        Some(_) => return Vec::new(),
    }
    vec![constants]
}

register_rubber! { "HyperElasticMooneyRivlin", energy, starts,
"Mooney–Rivlin material", "needs C10, C01, BULK_MODULUS; takes C20, C11, C02 for five terms",
"W = C₁₀ (Ī₁ − 3) + C₀₁ (Ī₂ − 3) + C₂₀ (Ī₁ − 3)² + C₁₁ (Ī₁ − 3)(Ī₂ − 3) + C₀₂ (Ī₂ − 3)² + ½ κ (J − 1)²; Rivlin and Saunders (1951)",
"C10", "C01", "C20", "C11", "C02" }
