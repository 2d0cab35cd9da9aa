//! Ogden's energy with any number of terms.
//!
//! W = Σ_p μ_p/α_p (λ̄₁^α_p + λ̄₂^α_p + λ̄₃^α_p − 3); the shear modulus at rest is ½ Σ μ_p α_p. (Abaqus divides by α² and doubles: its
//! μ_p is ½ μ_p α_p of here.)

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::Properties;

use super::constants::list;
use super::fit::{Constants, FitStart};
use super::rubber::{Energy, register_rubber};
use super::stretch_energy::{StretchEnergy, divided_power};

/// Constants of the energy.
#[derive(Debug, Clone, PartialEq)]
pub struct Ogden {
    /// μ_p and α_p of each term.
    pub terms: Vec<[f64; 2]>,
}

impl StretchEnergy for Ogden {
    fn derivatives(&self, stretch: f64) -> [f64; 3] {
        let log = stretch.ln();
        self.terms.iter().fold([0.0; 3], |[value, gamma, h], [modulus, exponent]| {
            let grown = (exponent * log).exp_m1();
            let own = modulus * (grown + 1.0);
            [value + modulus / exponent * grown, gamma + own, h + exponent * own]
        })
    }

    fn divided_difference(&self, first: f64, second: f64) -> f64 {
        self.terms.iter().map(|[modulus, exponent]| modulus * divided_power(0.5 * exponent - 1.0, first, second)).sum()
    }
}

/// # Errors
/// Lists that are missing or of different lengths, an exponent of 0.
fn energy(properties: &Properties) -> Result<Energy> {
    let (moduli, exponents) = (list(properties, "OGDEN_MODULI")?, list(properties, "OGDEN_EXPONENTS")?);
    let problem = |fact: String, remedy: &str| {
        Diagnostic::error("material-out-of-range", fact).at(properties.place.clone()).remedy(remedy.to_owned())
    };
    if moduli.is_empty() || moduli.len() != exponents.len() {
        let fact = format!(
            "properties {} have {} OGDEN_MODULI and {} OGDEN_EXPONENTS",
            properties.id,
            moduli.len(),
            exponents.len()
        );
        return Err(problem(fact, "give one modulus and one exponent for each term").into());
    }
    if let Some(exponent) = exponents.iter().find(|exponent| !exponent.is_finite() || **exponent == 0.0) {
        let fact = format!("an exponent of OGDEN_EXPONENTS of properties {} is {exponent}", properties.id);
        return Err(problem(fact, "give exponents other than 0").into());
    }
    let terms = moduli.iter().zip(exponents.iter()).map(|(modulus, exponent)| [*modulus, *exponent]).collect();
    Ok(Energy::Stretches(Box::new(Ogden { terms })))
}

/// Terms that share the shear modulus, with exponents in the order in which they are often found.
fn starts(start: &FitStart) -> Vec<Constants> {
    let terms = start.terms.unwrap_or(3);
    if !(1..=6).contains(&terms) {
        return Vec::new();
    }
    let sets = [[1.3, 5.0, -2.0, 8.0, -4.0, 3.0], [2.0, -2.0, 4.0, -4.0, 6.0, -6.0], [1.0, 9.0, -1.0, 4.0, -3.0, 12.0]];
    let shares = [0.8, 0.01, 0.19, 0.01, 0.01, 0.1];
    let sum: f64 = shares[..terms].iter().sum();
    let each = sets.into_iter().map(|exponents| {
        let moduli = exponents.iter().zip(shares).map(|(exponent, share)| 2.0 * share / sum * start.modulus / exponent);
        vec![("OGDEN_MODULI", moduli.take(terms).collect()), ("OGDEN_EXPONENTS", exponents[..terms].to_vec())]
    });
    each.collect()
}

register_rubber! { "HyperElasticOgden", energy, starts,
"Ogden material", "needs OGDEN_MODULI, OGDEN_EXPONENTS, BULK_MODULUS",
"W = Σ μ_p/α_p (λ̄₁^α_p + λ̄₂^α_p + λ̄₃^α_p − 3) + ½ κ (J − 1)²; Ogden, Proc. R. Soc. A 326 (1972)",
"OGDEN_MODULI", "OGDEN_EXPONENTS" }
