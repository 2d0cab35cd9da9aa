//! Yeoh's energy: W = C₁₀ (Ī₁ − 3) + C₂₀ (Ī₁ − 3)² + C₃₀ (Ī₁ − 3)³; the shear modulus at rest is 2 C₁₀.

use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;

use super::fit::{Constants, FitStart};
use super::rubber::{Energy, register_rubber};
use super::strain_energy::{EnergyDerivatives, InvariantEnergy};

/// Constants of the energy.
#[derive(Debug, Clone, PartialEq)]
pub struct Yeoh {
    /// C₁₀, C₂₀ and C₃₀.
    pub constants: [f64; 3],
}

impl InvariantEnergy for Yeoh {
    fn derivatives(&self, [first, ..]: [f64; 3]) -> EnergyDerivatives {
        let ([a, b, c], x) = (self.constants, first - 3.0);
        let mut out = EnergyDerivatives { value: x * (a + x * (b + x * c)), ..EnergyDerivatives::default() };
        out.first[0] = a + x * (2.0 * b + 3.0 * c * x);
        out.second[0][0] = 2.0 * b + 6.0 * c * x;
        out
    }
}

/// # Errors
/// Constants that are missing.
fn energy(properties: &Properties) -> Result<Energy> {
    let constants = [properties.require("C10")?, properties.require("C20")?, properties.require("C30")?];
    Ok(Energy::Invariants(Box::new(Yeoh { constants })))
}

fn starts(start: &FitStart) -> Vec<Constants> {
    if start.terms.is_some_and(|terms| terms != 3) {
        return Vec::new();
    }
    vec![vec![("C10", vec![0.5 * start.modulus]), ("C20", vec![0.0]), ("C30", vec![0.0])]]
}

register_rubber! { "HyperElasticYeoh", energy, starts,
"Yeoh material", "needs C10, C20, C30, BULK_MODULUS",
"W = C₁₀ (Ī₁ − 3) + C₂₀ (Ī₁ − 3)² + C₃₀ (Ī₁ − 3)³ + ½ κ (J − 1)²; Yeoh, Rubber Chem. Technol. 66 (1993)",
"C10", "C20", "C30" }
