//! Kinematic hardening of von Mises plasticity: the back stress β, the centre of the yield surface.
//!
//! β̇ = ⅔ C ε̇_p − γ β ṗ with the equivalent plastic strain p (Armstrong and Frederick, 1966; γ = 0: Prager). Implicit in a step:
//! β = θ (β_n + ⅔ C Δε_p) with θ = 1/(1 + γ Δp). In uniaxial tension the axial stress moves by 3/2 β_xx, which tends to C/γ.

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::{Properties, PropertyValue};

use super::hardening;
use super::j2::{J2, ON_SURFACE};
use crate::tensor::Tensor;

/// Kinematic hardening of a material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KinematicHardening {
    /// Modulus C (force per area).
    pub modulus: f64,
    /// Rate γ at which the back stress saturates, 0 where it does not.
    pub rate: f64,
}

/// Return mapping of a trial state with a back stress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KinematicReturn {
    /// Growth Δp of the equivalent plastic strain.
    pub delta: f64,
    /// Unit deviator n of the flow; zero where there is none.
    pub normal: Tensor,
    /// θ.
    pub recall: f64,
    /// ‖s_tr − θ β_n‖.
    pub size: f64,
    /// −d(excess of the von Mises stress)/dΔp.
    pub slope: f64,
}

impl KinematicReturn {
    /// A state that does not yield.
    pub const NONE: Self = Self {
        delta: 0.0,
        normal: Tensor::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        recall: 1.0,
        size: 0.0,
        slope: 1.0,
    };
}

/// Constants that laws with kinematic hardening take, beside those of [`hardening::CONSTANTS`].
const OWN: [&str; 2] = ["KINEMATIC_PLASTICITY_PARAMETERS", "KINEMATIC_HARDENING_TYPE"];

/// Constants that laws with combined hardening take.
pub const CONSTANTS: &[&str] = &{
    const COUNT: usize = hardening::CONSTANTS.len();
    let mut all = [""; COUNT + OWN.len()];
    let mut at = 0;
    while at < all.len() {
        all[at] = if at < COUNT { hardening::CONSTANTS[at] } else { OWN[at - COUNT] };
        at += 1;
    }
    all
};

impl KinematicHardening {
    /// KINEMATIC_HARDENING_TYPE 0 (linear, Prager) with C or 1 (Armstrong–Frederick) with C and γ as KINEMATIC_PLASTICITY_PARAMETERS.
    ///
    /// # Errors
    /// A type that is not there, parameters that are missing or out of range.
    pub fn of(properties: &Properties) -> Result<Self> {
        let problem = |fact: String, remedy: &str| {
            Diagnostic::error("kinematic-hardening", fact).at(properties.place.clone()).remedy(remedy.to_owned())
        };
        let parameters = match properties.values.get("KINEMATIC_PLASTICITY_PARAMETERS") {
            Some(PropertyValue::Vector(parameters)) => parameters.as_slice(),
            Some(PropertyValue::Number(modulus)) => &[*modulus],
            _ => properties.require("KINEMATIC_PLASTICITY_PARAMETERS").map(|_| &[][..])?,
        };
        let id = properties.id;
        let (modulus, rate) = match (properties.require("KINEMATIC_HARDENING_TYPE")?, parameters) {
            (0.0, &[modulus, ..]) => (modulus, 0.0),
            (1.0, &[modulus, rate, ..]) => (modulus, rate),
            (kind @ (0.0 | 1.0), given) => {
                let fact = format!(
                    "KINEMATIC_PLASTICITY_PARAMETERS of properties {id} has {} numbers for KINEMATIC_HARDENING_TYPE {kind}",
                    given.len()
                );
                return Err(problem(fact, "write [C] for type 0, [C, γ] for type 1").into());
            }
            (kind, _) => {
                let fact = format!("KINEMATIC_HARDENING_TYPE {kind} of properties {id} is not there");
                return Err(problem(fact, "use 0 (linear) or 1 (Armstrong–Frederick)").into());
            }
        };
        if !(modulus >= 0.0 && modulus.is_finite() && rate >= 0.0 && rate.is_finite()) {
            let fact = format!("KINEMATIC_PLASTICITY_PARAMETERS of properties {id} are {parameters:?}");
            return Err(problem(fact, "give C and γ that are not negative").into());
        }
        Ok(Self { modulus, rate })
    }

    /// β after a step.
    pub fn moved(&self, before: &Tensor, turn: &KinematicReturn) -> Tensor {
        turn.recall * (before + (1.5_f64.sqrt() / 1.5 * self.modulus * turn.delta) * turn.normal)
    }

    /// The return of the trial deviator `s` from the back stress `before` and the equivalent plastic strain `alpha`.
    ///
    /// Δp solves √(3/2) ‖s − θ β_n‖ − (3μ + C θ) Δp = σ_y(α + Δp). The left side falls: ‖β_n‖ is at most √(2/3) C/γ.
    pub fn turn_back(&self, j2: &J2, s: &Tensor, before: &Tensor, alpha: f64) -> KinematicReturn {
        let root = 1.5_f64.sqrt();
        let (three_mu, hardening) = (3.0 * j2.mu, &j2.hardening);
        // excess, its slope, and what remains of it
        let at = |delta: f64| {
            let recall = 1.0 / (1.0 + self.rate * delta);
            let relative = s - recall * before;
            let size = relative.norm();
            let normal = if size > 0.0 { relative / size } else { Tensor::zeros() };
            let (limit, steeper) = hardening.at(alpha + delta);
            let square = recall * recall;
            let slope = three_mu + self.modulus * square + steeper - root * self.rate * square * normal.dot(before);
            let excess = root * size - (three_mu + self.modulus * recall) * delta - limit;
            (excess, KinematicReturn { delta, normal, recall, size, slope })
        };
        let (excess, still) = at(0.0);
        if excess <= ON_SURFACE * hardening.at(alpha).0 || excess.is_nan() {
            return KinematicReturn::NONE;
        }
        let (mut low, mut high) = (0.0, root * (s.norm() + before.norm()) / three_mu);
        let (mut excess, mut found) = (excess, still);
        for _ in 0..100 {
            if excess > 0.0 {
                low = found.delta;
            } else {
                high = found.delta;
            }
            if excess.abs() <= 1e-15 * root * found.size {
                break;
            }
            let next = found.delta + excess / found.slope;
            let inside = if next > low && next < high { next } else { 0.5 * (low + high) };
            if inside == found.delta {
                break;
            }
            (excess, found) = at(inside);
        }
        found
    }
}
