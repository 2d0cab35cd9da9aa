//! Gent's energy: W = −½ μ J_m ln(1 − (Ī₁ − 3)/J_m), which is defined for Ī₁ − 3 < J_m; μ is the shear modulus at rest.

use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;

use super::constants::positive;
use super::fit::{Constants, FitStart};
use super::rubber::{Energy, register_rubber};
use super::strain_energy::{EnergyDerivatives, InvariantEnergy};

/// Constants of the energy.
#[derive(Debug, Clone, PartialEq)]
pub struct Gent {
    /// μ.
    pub modulus: f64,
    /// J_m.
    pub limit: f64,
}

impl InvariantEnergy for Gent {
    fn derivatives(&self, [first, ..]: [f64; 3]) -> EnergyDerivatives {
        let x = first - 3.0;
        // beyond the limit there is no energy: the increment is shortened
        let rest = if x < self.limit { 1.0 - x / self.limit } else { f64::NAN };
        let mut out = EnergyDerivatives {
            value: -0.5 * self.modulus * self.limit * (-x / self.limit).ln_1p(),
            ..EnergyDerivatives::default()
        };
        out.first[0] = 0.5 * self.modulus / rest;
        out.second[0][0] = 0.5 * self.modulus / (self.limit * rest * rest);
        out
    }
}

/// # Errors
/// Constants that are missing or not positive.
fn energy(properties: &Properties) -> Result<Energy> {
    let (modulus, limit) = (positive(properties, "SHEAR_MODULUS")?, positive(properties, "GENT_LIMIT")?);
    Ok(Energy::Invariants(Box::new(Gent { modulus, limit })))
}

fn starts(start: &FitStart) -> Vec<Constants> {
    if start.terms.is_some() {
        return Vec::new();
    }
    let limit = |factor: f64| factor * (start.invariant - 3.0).max(0.01);
    [1.05, 1.3, 3.0]
        .map(|factor| vec![("SHEAR_MODULUS", vec![start.modulus]), ("GENT_LIMIT", vec![limit(factor)])])
        .into()
}

register_rubber! { "HyperElasticGent", energy, starts,
"Gent material", "needs SHEAR_MODULUS, GENT_LIMIT, BULK_MODULUS",
"W = −½ μ J_m ln(1 − (Ī₁ − 3)/J_m) + ½ κ (J − 1)²; Gent, Rubber Chem. Technol. 69 (1996)",
"SHEAR_MODULUS", "GENT_LIMIT" }
