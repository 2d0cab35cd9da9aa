//! Mullins' softening of rubber below its largest deformation so far, by Ogden and Roxburgh (Proc. R. Soc. A 455, 1999).
//!
//! The stress of the isochoric energy W is multiplied by η = 1 − erf(u)/r, u = (W_m − W)/(m + β W_m), where W_m is the largest W so
//! far; η = 1 on the primary path. The energy that can be recovered is η W + φ(η), φ = (W_m erf u − M (1 − exp(−u²))/√π)/r with
//! M = m + β W_m, so that its derivative is the stress. The history of a point is W_m.

use std::f64::consts::PI;

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::Properties;

/// Constants of the softening.
pub const CONSTANTS: [&str; 3] = ["MULLINS_R", "MULLINS_M", "MULLINS_BETA"];

/// Constants of the softening.
#[derive(Debug, Clone, PartialEq)]
pub struct Mullins {
    /// r.
    ratio: f64,
    /// m.
    energy: f64,
    /// β.
    slope: f64,
}

/// η, dη/dW and the energy that can be recovered.
#[derive(Debug, Clone, Copy)]
pub struct Softening {
    /// η.
    pub(super) factor: f64,
    /// dη/dW.
    pub(super) slope: f64,
    /// η W + φ(η).
    pub(super) energy: f64,
}

/// The error function for x ≥ 0, by a series of positive terms.
pub fn error_function(x: f64) -> f64 {
    if x > 6.0 {
        return 1.0;
    }
    let (mut term, mut sum, mut odd) = (x, x, 1.0);
    while term > 1e-17 * sum {
        odd += 2.0;
        term *= 2.0 * x * x / odd;
        sum += term;
    }
    2.0 / PI.sqrt() * (-x * x).exp() * sum
}

impl Mullins {
    /// The softening of the properties, where they give it.
    ///
    /// # Errors
    /// Constants that are missing or out of range.
    pub(super) fn of(properties: &Properties) -> Result<Option<Self>> {
        if !CONSTANTS.iter().any(|name| properties.values.contains_key(*name)) {
            return Ok(None);
        }
        let [ratio, energy] = [properties.require("MULLINS_R")?, properties.require("MULLINS_M")?];
        let slope = properties.number("MULLINS_BETA").unwrap_or(0.0);
        for (name, value, is_within, range) in [
            ("MULLINS_R", ratio, ratio > 1.0 && ratio.is_finite(), "above 1"),
            ("MULLINS_M", energy, energy >= 0.0 && energy.is_finite(), "from 0"),
            ("MULLINS_BETA", slope, slope >= 0.0 && slope.is_finite(), "from 0"),
            ("MULLINS_M + MULLINS_BETA", energy + slope, energy + slope > 0.0, "with a positive sum"),
        ] {
            if !is_within {
                let fact = format!("{name} of properties {} is {value}", properties.id);
                let problem = Diagnostic::error("material-out-of-range", fact).at(properties.place.clone());
                return Err(problem.remedy(format!("give numbers {range}")).into());
            }
        }
        Ok(Some(Self { ratio, energy, slope }))
    }

    /// Softening at the energy W where the largest so far was `largest`.
    pub(super) fn at(&self, energy: f64, largest: f64) -> Softening {
        if energy >= largest {
            return Softening { factor: 1.0, slope: 0.0, energy };
        }
        let scale = self.energy + self.slope * largest;
        let u = (largest - energy) / scale;
        let (lost, gauss) = (error_function(u), (-u * u).exp());
        let factor = 1.0 - lost / self.ratio;
        let stored = (largest * lost + scale * (-u * u).exp_m1() / PI.sqrt()) / self.ratio;
        Softening { factor, slope: 2.0 * gauss / (PI.sqrt() * self.ratio * scale), energy: factor * energy + stored }
    }
}
