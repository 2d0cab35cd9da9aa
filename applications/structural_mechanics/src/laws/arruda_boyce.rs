//! Arruda's and Boyce's energy of eight chains, with five terms of the inverse Langevin function.
//!
//! W = μ Σ α_i λ_L^(2 − 2i) (Ī₁^i − 3^i), α = ½, 1/20, 11/1050, 19/7000, 519/673750, with the stretch λ_L at which chains lock. The
//! shear modulus at rest is μ (1 + 3/(5 λ_L²) + 99/(175 λ_L⁴) + 513/(875 λ_L⁶) + 42039/(67375 λ_L⁸)).

use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;

use super::constants::positive;
use super::fit::{Constants, FitStart};
use super::rubber::{Energy, register_rubber};
use super::strain_energy::{EnergyDerivatives, InvariantEnergy};

/// α_i.
const SERIES: [f64; 5] = [0.5, 1.0 / 20.0, 11.0 / 1050.0, 19.0 / 7000.0, 519.0 / 673_750.0];

/// Constants of the energy.
#[derive(Debug, Clone, PartialEq)]
pub struct ArrudaBoyce {
    /// μ.
    pub modulus: f64,
    /// λ_L.
    pub locking: f64,
}

impl InvariantEnergy for ArrudaBoyce {
    fn derivatives(&self, [first, ..]: [f64; 3]) -> EnergyDerivatives {
        let mut out = EnergyDerivatives::default();
        let mut factor = self.modulus;
        for (at, share) in SERIES.into_iter().enumerate() {
            let i = at as i32 + 1;
            let (power, n) = (factor * share, f64::from(i));
            out.value += power * (first.powi(i) - 3.0_f64.powi(i));
            out.first[0] += power * n * first.powi(i - 1);
            out.second[0][0] += power * n * (n - 1.0) * first.powi(i - 2);
            factor /= self.locking * self.locking;
        }
        out
    }
}

/// # Errors
/// Constants that are missing or not positive.
fn energy(properties: &Properties) -> Result<Energy> {
    let (modulus, locking) = (positive(properties, "SHEAR_MODULUS")?, positive(properties, "LOCKING_STRETCH")?);
    Ok(Energy::Invariants(Box::new(ArrudaBoyce { modulus, locking })))
}

fn starts(start: &FitStart) -> Vec<Constants> {
    if start.terms.is_some() {
        return Vec::new();
    }
    let chain = (start.invariant / 3.0).sqrt();
    [1.0, 1.5, 3.0]
        .map(|factor| vec![("SHEAR_MODULUS", vec![start.modulus]), ("LOCKING_STRETCH", vec![factor * chain])])
        .into()
}

register_rubber! { "HyperElasticArrudaBoyce", energy, starts,
"Arruda–Boyce material", "needs SHEAR_MODULUS, LOCKING_STRETCH, BULK_MODULUS",
"W = μ Σ α_i λ_L^(2 − 2i) (Ī₁^i − 3^i) + ½ κ (J − 1)², five terms; Arruda and Boyce, J. Mech. Phys. Solids 41 (1993)",
"SHEAR_MODULUS", "LOCKING_STRETCH" }
