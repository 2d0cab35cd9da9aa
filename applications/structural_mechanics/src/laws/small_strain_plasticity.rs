//! Von Mises plasticity with isotropic hardening under small strain.
//!
//! σ = K tr(ε) 1 + 2μ dev(ε − ε_p), ‖dev σ‖ √(3/2) ≤ σ_y(α), radial return ([`super::j2`]). The tangent is that of the
//! return: D = K 1⊗1 + 2μ (kept (I − 1⊗1/3) − lost n⊗n). Plane strain keeps ε_zz = 0 and all of ε_p. In elements of
//! finite deformation ε is Green–Lagrange's and σ the second Piola–Kirchhoff stress: for small strains, large rotations.
//!
//! The history of a point is ε_p (tensor components xx yy zz xy yz xz) and α.

use crate::laws::LawEntry;
use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;
use zelus_core::register;

use super::hardening;
use super::j2::{J2, Return};
use super::law::{ConstitutiveLaw, LawFactory, Matrix, StrainState};
use crate::tensor::{Tensor, deviator, pairs, strain_tensor, strain_vector, stress_tensor, stress_vector};

/// Von Mises plasticity under small strain.
#[derive(Debug, Clone, PartialEq)]
pub struct SmallStrainPlasticity(pub J2);

/// A trial state and its return.
struct SmallStrainTrial {
    /// Trial deviator of the stress.
    s: Tensor,
    /// Its norm.
    size: f64,
    /// tr ε.
    dilation: f64,
    turn: Return,
}

/// Plastic strain and equivalent plastic strain that a history holds.
pub(super) fn remembered(history: &[f64]) -> (Tensor, f64) {
    let &[xx, yy, zz, xy, yz, xz, alpha] = history else { unreachable!("plasticity remembers seven numbers") };
    (stress_tensor(&[xx, yy, zz, xy, yz, xz]), alpha)
}

/// Writes a tensor and the equivalent plastic strain into a history.
pub(super) fn remember(tensor: &Tensor, alpha: f64, history: &mut [f64]) {
    history[..6].copy_from_slice(&stress_vector::<6>(tensor));
    history[6] = alpha;
}

/// The work of the stress on the plastic strain of the step that is not yet accepted, by initial volume.
pub const PLASTIC_WORK: &str = "PLASTIC_WORK_INCREMENT";

/// Variables of plastic laws from their history: equivalent plastic strain under its names, the plastic strain as a vector.
pub(super) fn answer<const S: usize>(plastic: &Tensor, alpha: f64, variable: &str, out: &mut Vec<f64>) -> bool {
    match variable {
        "EQUIVALENT_PLASTIC_STRAIN" | "ACCUMULATED_PLASTIC_STRAIN" => out.push(alpha),
        "PLASTIC_STRAIN_VECTOR" => out.extend_from_slice(&strain_vector::<S>(plastic)),
        _ => return false,
    }
    true
}

impl SmallStrainPlasticity {
    fn trial<const S: usize>(&self, state: &StrainState<'_, S>) -> SmallStrainTrial {
        let (plastic, alpha) = remembered(state.history);
        let strain = strain_tensor(&state.strain);
        let s = 2.0 * self.0.mu * (deviator(&strain) - plastic);
        let size = s.norm();
        SmallStrainTrial {
            s,
            size,
            dilation: strain.trace(),
            turn: if state.elastic { Return::NONE } else { self.0.turn_back(1.5_f64.sqrt() * size, alpha) },
        }
    }

    fn boxed<const S: usize>(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<S>>> {
        Ok(Box::new(Self(J2::of(properties)?)))
    }
}

impl<const S: usize> ConstitutiveLaw<S> for SmallStrainPlasticity {
    fn pk2(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        let SmallStrainTrial { s, size, dilation, turn } = self.trial(state);
        let (pairs, unit) = (pairs::<S>(), |p, q| if p == q { 1.0 } else { 0.0 });
        if let Some(tangent) = tangent {
            let two_mu = 2.0 * self.0.mu;
            let lost = if turn.delta > 0.0 { two_mu * turn.lost / (size * size) } else { 0.0 };
            for (row, (i, j)) in tangent.iter_mut().zip(pairs) {
                for (entry, (p, q)) in row.iter_mut().zip(pairs) {
                    let symmetric = 0.5 * (unit(i, p) * unit(j, q) + unit(i, q) * unit(j, p));
                    let volume = unit(i, j) * unit(p, q);
                    *entry = self.0.bulk * volume + two_mu * turn.kept * (symmetric - volume / 3.0)
                        - lost * (s[(i, j)] * s[(p, q)]);
                }
            }
        }
        pairs.map(|(i, j)| self.0.bulk * dilation * unit(i, j) + turn.kept * s[(i, j)])
    }

    /// The elastic part: ½ K tr²(ε) + ‖dev σ‖²/4μ.
    fn energy(&self, state: &StrainState<'_, S>) -> f64 {
        let SmallStrainTrial { size, dilation, turn, .. } = self.trial(state);
        0.5 * self.0.bulk * dilation * dilation + (turn.kept * size).powi(2) / (4.0 * self.0.mu)
    }

    fn ignores_measure(&self, small: bool) -> bool {
        small
    }

    fn history(&self) -> usize {
        7
    }

    fn advance(&self, state: &StrainState<'_, S>, history: &mut [f64]) {
        let SmallStrainTrial { s, turn, .. } = self.trial(state);
        let (mut plastic, alpha) = remembered(state.history);
        let share = (1.0 - turn.kept) / (2.0 * self.0.mu);
        plastic += share * s;
        remember(&plastic, alpha + turn.delta, history);
    }

    fn internal(&self, state: &StrainState<'_, S>, variable: &str, out: &mut Vec<f64>) -> bool {
        if let "UNIAXIAL_STRESS" | PLASTIC_WORK = variable {
            let SmallStrainTrial { size, turn, .. } = self.trial(state);
            let q = 1.5_f64.sqrt() * turn.kept * size;
            out.push(if variable == PLASTIC_WORK { q * turn.delta } else { q });
            return true;
        }
        let (plastic, alpha) = remembered(state.history);
        answer::<S>(&plastic, alpha, variable, out)
    }
}

register! { LawEntry "SmallStrainJ2Plasticity3DLaw",
    about: "Von Mises plasticity under small strain for solids; needs YOUNG_MODULUS, POISSON_RATIO, YIELD_STRESS; takes ISOTROPIC_HARDENING_MODULUS, EXPONENTIAL_SATURATION_YIELD_STRESS, HARDENING_EXPONENT or a HARDENING_CURVE",
    source: "‖dev σ‖ √(3/2) ≤ σ_y(α); Simo and Hughes, Computational Inelasticity, box 3.2",
    takes: hardening::CONSTANTS,
    build: LawFactory::Space(SmallStrainPlasticity::boxed::<6>),
}

register! { LawEntry "SmallStrainJ2PlasticityPlaneStrain2DLaw",
    about: "Von Mises plasticity under small plane strain; properties as SmallStrainJ2Plasticity3DLaw",
    source: "‖dev σ‖ √(3/2) ≤ σ_y(α) with ε_zz = 0",
    takes: hardening::CONSTANTS,
    build: LawFactory::PlaneStrain { plane: SmallStrainPlasticity::boxed::<3>, whole: SmallStrainPlasticity::boxed::<4> },
}

register! { LawEntry "SmallStrainJ2PlasticityAxisym2DLaw",
    about: "Von Mises plasticity under small strain with axial symmetry; properties as SmallStrainJ2Plasticity3DLaw",
    source: "‖dev σ‖ √(3/2) ≤ σ_y(α) on (rr, zz, tt, rz)",
    takes: hardening::CONSTANTS,
    build: LawFactory::Axisymmetric(SmallStrainPlasticity::boxed::<4>),
}

register! { LawEntry "SmallStrainIsotropicPlasticity3DVonMisesVonMises",
    about: "Von Mises plasticity under small strain for solids, by HARDENING_CURVE 3, 4 or 6; otherwise as SmallStrainJ2Plasticity3DLaw",
    source: "‖dev σ‖ √(3/2) ≤ σ_y(α), associated flow",
    takes: hardening::CONSTANTS,
    build: LawFactory::Space(SmallStrainPlasticity::boxed::<6>),
}

register! { LawEntry "SmallStrainIsotropicPlasticityPlaneStrainVonMisesVonMises",
    about: "Von Mises plasticity under small plane strain, by HARDENING_CURVE 3, 4 or 6; otherwise as SmallStrainJ2PlasticityPlaneStrain2DLaw",
    source: "‖dev σ‖ √(3/2) ≤ σ_y(α), associated flow, ε_zz = 0",
    takes: hardening::CONSTANTS,
    build: LawFactory::PlaneStrain { plane: SmallStrainPlasticity::boxed::<3>, whole: SmallStrainPlasticity::boxed::<4> },
}
