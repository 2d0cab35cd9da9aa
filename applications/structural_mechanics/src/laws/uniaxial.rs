//! Elastic and plastic laws along a bar.
//!
//! Plastic bars yield at |S| = YIELD_STRESS + HARDENING_MODULUS_1D α, α the accumulated plastic strain: from the trial
//! stress E (ε − ε_p) + S_0 the return is Δα = (|S| − yield)/(E + H), the tangent E H/(E + H).

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::Properties;
use zelus_core::register;

use super::bar_law::BarLaw;
use super::law::{LawEntry, LawFactory};

/// Modulus, and with yielding the yield stress and the hardening modulus.
struct Uniaxial {
    young: f64,
    plastic: Option<[f64; 2]>,
}

impl BarLaw for Uniaxial {
    /// The history holds the plastic strain and its sum.
    fn response(&self, strain: f64, prestress: f64, [plastic, sum]: [f64; 2]) -> (f64, f64, [f64; 2]) {
        let trial = self.young * (strain - plastic) + prestress;
        let Some([yield_stress, hardening]) = self.plastic else { return (trial, self.young, [plastic, sum]) };
        let over = trial.abs() - (yield_stress + hardening * sum);
        if over <= 0.0 {
            return (trial, self.young, [plastic, sum]);
        }
        let both = self.young + hardening;
        let (step, sign) = (over / both, trial.signum());
        (trial - sign * self.young * step, self.young * hardening / both, [plastic + sign * step, sum + step])
    }

    fn is_linear(&self) -> bool {
        self.plastic.is_none()
    }
}

fn elastic(properties: &Properties) -> Result<Box<dyn BarLaw>> {
    let young = properties.require("YOUNG_MODULUS")?;
    positive(properties, "YOUNG_MODULUS", young)?;
    Ok(Box::new(Uniaxial { young, plastic: None }))
}

fn plastic(properties: &Properties) -> Result<Box<dyn BarLaw>> {
    let (yield_stress, young) = (properties.require("YIELD_STRESS")?, properties.require("YOUNG_MODULUS")?);
    let hardening = properties.number("HARDENING_MODULUS_1D").unwrap_or(0.0);
    positive(properties, "YOUNG_MODULUS", young)?;
    positive(properties, "YIELD_STRESS", yield_stress)?;
    positive(properties, "HARDENING_MODULUS_1D + YOUNG_MODULUS", hardening + young)?;
    Ok(Box::new(Uniaxial { young, plastic: Some([yield_stress, hardening]) }))
}

/// # Errors
/// A constant of bars that is not positive.
pub(crate) fn positive(properties: &Properties, name: &str, value: f64) -> Result<()> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    let fact = format!("{name} of properties {} is {value}", properties.id);
    let problem = Diagnostic::error("material-out-of-range", fact).at(properties.place.clone());
    Err(problem.remedy("give a positive number").into())
}

register! { LawEntry "TrussConstitutiveLaw",
    about: "Hooke's law along a bar, for trusses; needs YOUNG_MODULUS",
    source: "S = E E_gl",
    build: LawFactory::Bar(elastic),
}

register! { LawEntry "TrussPlasticityConstitutiveLaw",
    about: "Yielding along a bar, with linear hardening, for trusses; needs YOUNG_MODULUS, YIELD_STRESS, HARDENING_MODULUS_1D",
    source: "|S| ≤ YIELD_STRESS + H α",
    takes: &["YIELD_STRESS", "HARDENING_MODULUS_1D"],
    build: LawFactory::Bar(plastic),
}
