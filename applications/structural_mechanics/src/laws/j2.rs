//! Radial return of von Mises plasticity with isotropic hardening.
//!
//! With the trial value q of the von Mises stress, the equivalent plastic strain grows by Δ ≥ 0 so that q − 3μΔ = σ_y(α + Δ); the
//! deviator shrinks to its (1 − 3μΔ/q)-th part. Small strain and finite strain share this and differ in the strain: there it is linear,
//! here it is the logarithm of the elastic stretches.

use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;

use super::elastic::Elasticity;
use super::hardening::Hardening;

/// Excess over the yield stress, relative to it, that still counts as elastic: round-off of accepted states.
pub(super) const ON_SURFACE: f64 = 1e-12;

/// Constants of the material.
#[derive(Debug, Clone, PartialEq)]
pub struct J2 {
    /// Bulk modulus K.
    pub bulk: f64,
    /// Shear modulus μ.
    pub mu: f64,
    /// Yield stress over equivalent plastic strain.
    pub hardening: Hardening,
}

/// Return mapping of a trial state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Return {
    /// Growth Δ of the equivalent plastic strain.
    pub delta: f64,
    /// The part of the trial deviator that stays, 1 − 3μΔ/q.
    pub kept: f64,
    /// Factor f of the tangent 2μ (kept (1 − 1⊗1/3) − f n⊗n), n the unit deviator: 1/(1 + σ_y'/3μ) − (1 − kept).
    pub lost: f64,
}

impl Return {
    /// A state that does not yield.
    pub const NONE: Self = Self { delta: 0.0, kept: 1.0, lost: 0.0 };
}

impl J2 {
    /// The material of the properties.
    ///
    /// # Errors
    /// As [`Elasticity::of`] and [`Hardening::of`].
    pub fn of(properties: &Properties) -> Result<Self> {
        let elastic = Elasticity::of(properties)?;
        let mu = elastic.mu();
        Ok(Self { bulk: elastic.lambda() + 2.0 / 3.0 * mu, mu, hardening: Hardening::of(properties)? })
    }

    /// The return of a trial state with von Mises stress `q`, from the equivalent plastic strain `alpha`.
    pub fn turn_back(&self, q: f64, alpha: f64) -> Return {
        let (limit, _) = self.hardening.at(alpha);
        if q <= limit * (1.0 + ON_SURFACE) || q.is_nan() {
            return Return::NONE;
        }
        let three_mu = 3.0 * self.mu;
        // the excess falls from positive at 0 to negative at q/3μ: Newton's method, kept inside
        let (mut low, mut high, mut delta) = (0.0, q / three_mu, 0.0);
        for _ in 0..100 {
            let (limit, slope) = self.hardening.at(alpha + delta);
            let excess = q - three_mu * delta - limit;
            if excess > 0.0 {
                low = delta;
            } else {
                high = delta;
            }
            if excess.abs() <= 1e-15 * q {
                break;
            }
            let next = delta + excess / (three_mu + slope);
            let inside = if next > low && next < high { next } else { 0.5 * (low + high) };
            if inside == delta {
                break;
            }
            delta = inside;
        }
        let kept = 1.0 - three_mu * delta / q;
        let slope = self.hardening.at(alpha + delta).1;
        Return { delta, kept, lost: 1.0 / (1.0 + slope / three_mu) - (1.0 - kept) }
    }
}
