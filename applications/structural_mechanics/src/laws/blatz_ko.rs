//! Blatz's and Ko's energy of rubber foam, which changes its volume.
//!
//! W = ½ f μ (I₁ − 3 + (J^(−2β) − 1)/β) + ½ (1 − f) μ (I₂/J² − 3 + (J^(2β) − 1)/β), β = ν/(1 − 2ν). I₁ = J^(2/3) Ī₁ and I₂/J² =
//! J^(−2/3) Ī₂. f = 0 is foam, f = 1 a solid; the shear modulus at rest is μ, Poisson's ratio ν.

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::Properties;

use super::constants::positive;
use super::rubber::{Energy, register_foam};
use super::strain_energy::{EnergyDerivatives, InvariantEnergy};

/// Constants of the energy.
#[derive(Debug, Clone, PartialEq)]
pub struct BlatzKo {
    /// μ.
    pub modulus: f64,
    /// β.
    pub beta: f64,
    /// f.
    pub share: f64,
}

/// Factor of one invariant times J^p, and of (J^q − 1)/b: value and derivatives by J.
fn power(j: f64, p: f64) -> [f64; 3] {
    let value = j.powf(p);
    [value, p * value / j, p * (p - 1.0) * value / (j * j)]
}

impl InvariantEnergy for BlatzKo {
    fn derivatives(&self, [one, two, j]: [f64; 3]) -> EnergyDerivatives {
        let mut out = EnergyDerivatives::default();
        let sides = [
            (0, one, self.share, 2.0 / 3.0, -2.0 * self.beta),
            (1, two, 1.0 - self.share, -2.0 / 3.0, 2.0 * self.beta),
        ];
        for (at, invariant, share, of_shape, of_volume) in sides {
            let half = 0.5 * self.modulus * share;
            let (shape, volume) = (power(j, of_shape), power(j, of_volume));
            out.value += half * (invariant * shape[0] - 3.0 + (volume[0] - 1.0) / self.beta);
            out.first[at] += half * shape[0];
            out.first[2] += half * (invariant * shape[1] + volume[1] / self.beta);
            out.second[2][2] += half * (invariant * shape[2] + volume[2] / self.beta);
            out.second[at][2] += half * shape[1];
            out.second[2][at] += half * shape[1];
        }
        out
    }
}

/// # Errors
/// Constants that are missing or out of range.
fn energy(properties: &Properties) -> Result<Energy> {
    let modulus = positive(properties, "SHEAR_MODULUS")?;
    let (ratio, share) = (properties.require("POISSON_RATIO")?, properties.number("BLATZ_KO_SHARE").unwrap_or(0.0));
    for (name, value, is_within, range) in [
        ("POISSON_RATIO", ratio, ratio > 0.0 && ratio < 0.5, "above 0 and below 0.5; 0.25 is Blatz's and Ko's foam"),
        ("BLATZ_KO_SHARE", share, (0.0..=1.0).contains(&share), "from 0 (foam) to 1 (solid)"),
    ] {
        if !is_within {
            let fact = format!("{name} of properties {} is {value}", properties.id);
            let problem = Diagnostic::error("material-out-of-range", fact).at(properties.place.clone());
            return Err(problem.remedy(format!("give a value {range}")).into());
        }
    }
    Ok(Energy::Invariants(Box::new(BlatzKo { modulus, beta: ratio / (1.0 - 2.0 * ratio), share })))
}

register_foam! { "HyperElasticBlatzKo", energy, |_| Vec::new(),
"Blatz–Ko material, rubber foam that changes its volume", "needs SHEAR_MODULUS, POISSON_RATIO; takes BLATZ_KO_SHARE",
"W = ½ f μ (I₁ − 3 + (J^(−2β) − 1)/β) + ½ (1 − f) μ (I₂/J² − 3 + (J^(2β) − 1)/β); Blatz and Ko, Trans. Soc. Rheol. 6 (1962)",
"SHEAR_MODULUS", "BLATZ_KO_SHARE" }
