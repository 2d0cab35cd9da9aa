//! Von Mises plasticity with isotropic hardening under finite strain.
//!
//! F = F_e F_p with G = C_p⁻¹ = F_p⁻¹ F_p⁻ᵀ remembered. With a factor L of G = L Lᵀ the trial elastic stretches are the
//! eigenvalues λ_A² of Lᵀ C L, with vectors N_A. Kirchhoff stress τ_A = K Σ ε_B + kept · 2μ dev ε_A of the trial logarithms
//! ε_A = ln λ_A, returned as under small strain ([`super::j2`]). With M_A = L N_A and s_A = τ_A/λ_A²
//!
//! S = Σ s_A M_A ⊗ M_A,  dS = Σ D_AB (M_A ⊗ M_A)(M_B · dE M_B) + Σ_{A<B} γ_AB (M_A ⊗ M_B + M_B ⊗ M_A)(M_A · dE M_B),
//!
//! D_AB = (∂τ_A/∂ε_B − 2 τ_A δ_AB)/(λ_A² λ_B²), γ_AB = 2 (s_A − s_B)/(λ_A² − λ_B²). Flow by the exponential map:
//! G ← Σ exp(2 (kept − 1) dev ε_A) M_A ⊗ M_A, which keeps det G = 1. Only C enters, so the law does not see rotations.
//!
//! The history of a point is G − 1 (xx yy zz xy yz xz) and α.

use crate::laws::LawEntry;
use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;
use zelus_core::register;

use super::hardening;
use super::hyper_elastic::right_cauchy_green;
use super::j2::{J2, Return};
use super::law::{ConstitutiveLaw, LawFactory, Matrix, StrainState};
use super::small_strain_plasticity::{PLASTIC_WORK, answer, remember, remembered};
use crate::tensor::{IDENTITY, Tensor, cholesky, congruent, eigen, pairs};

/// Relative distance of eigenvalues below which their difference quotient is the derivative.
const CLOSE: f64 = 1e-5;

/// Von Mises plasticity under finite strain, by logarithmic elastic stretches.
#[derive(Debug, Clone, PartialEq)]
pub struct FiniteStrainPlasticity(pub J2);

/// A trial state by its principal axes, and its return.
struct FiniteStrainTrial {
    /// λ_A².
    squares: [f64; 3],
    /// Σ ε_A.
    dilation: f64,
    /// dev ε_A.
    dev: [f64; 3],
    /// M_A as columns.
    axes: Tensor,
    turn: Return,
}

impl FiniteStrainPlasticity {
    fn trial<const S: usize>(&self, state: &StrainState<'_, S>) -> FiniteStrainTrial {
        let (g, alpha) = remembered(state.history);
        let l = cholesky(&(IDENTITY + g));
        let (squares, vectors) = eigen(&congruent(&l.transpose(), &right_cauchy_green(state)));
        let squares: [f64; 3] = squares.into();
        let logs = squares.map(|s| 0.5 * s.ln());
        let dilation: f64 = logs.iter().sum();
        let dev = logs.map(|e| e - dilation / 3.0);
        let q = 2.0 * self.0.mu * (1.5 * dev.iter().map(|e| e * e).sum::<f64>()).sqrt();
        FiniteStrainTrial {
            squares,
            dilation,
            dev,
            axes: l * vectors,
            turn: if state.elastic { Return::NONE } else { self.0.turn_back(q, alpha) },
        }
    }

    /// τ_A.
    fn kirchhoff(&self, trial: &FiniteStrainTrial) -> [f64; 3] {
        trial.dev.map(|e| self.0.bulk * trial.dilation + 2.0 * self.0.mu * trial.turn.kept * e)
    }

    /// D_AB.
    fn principal_tangent(&self, trial: &FiniteStrainTrial, tau: &[f64; 3]) -> Tensor {
        let two_mu = 2.0 * self.0.mu;
        let size: f64 = trial.dev.iter().map(|e| e * e).sum();
        let lost = if trial.turn.delta > 0.0 { two_mu * trial.turn.lost / size } else { 0.0 };
        Tensor::from_fn(|a, b| {
            let same = IDENTITY[(a, b)];
            let slope =
                self.0.bulk + two_mu * trial.turn.kept * (same - 1.0 / 3.0) - lost * (trial.dev[a] * trial.dev[b]);
            (slope - 2.0 * tau[a] * same) / (trial.squares[a] * trial.squares[b])
        })
    }

    fn boxed<const S: usize>(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<S>>> {
        Ok(Box::new(Self(J2::of(properties)?)))
    }
}

impl<const S: usize> ConstitutiveLaw<S> for FiniteStrainPlasticity {
    fn pk2(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        let trial = self.trial(state);
        let (m, squares, tau) = (&trial.axes, &trial.squares, self.kirchhoff(&trial));
        let s: [f64; 3] = std::array::from_fn(|a| tau[a] / squares[a]);
        let dyads: [[f64; S]; 3] = std::array::from_fn(|a| pairs::<S>().map(|(i, j)| m[(i, a)] * m[(j, a)]));
        if let Some(tangent) = tangent {
            let d = self.principal_tangent(&trial, &tau);
            *tangent = [[0.0; S]; S];
            for a in 0..3 {
                for b in 0..3 {
                    add_dyad(d[(a, b)], &dyads[a], &dyads[b], tangent);
                }
                for b in a + 1..3 {
                    let distance = squares[a] - squares[b];
                    let shear = if distance.abs() > CLOSE * squares[a] {
                        2.0 * (s[a] - s[b]) / distance
                    } else {
                        0.5 * (d[(a, a)] - d[(a, b)] - d[(b, a)] + d[(b, b)])
                    };
                    let mixed = pairs::<S>().map(|(i, j)| m[(i, a)] * m[(j, b)] + m[(i, b)] * m[(j, a)]);
                    add_dyad(0.5 * shear, &mixed, &mixed, tangent);
                }
            }
        }
        std::array::from_fn(|v| (0..3).map(|a| s[a] * dyads[a][v]).sum())
    }

    /// The elastic part: ½ K (Σ ε)² + μ Σ (dev ε_e)².
    fn energy(&self, state: &StrainState<'_, S>) -> f64 {
        let trial = self.trial(state);
        let dev: f64 = trial.dev.iter().map(|e| (trial.turn.kept * e).powi(2)).sum();
        0.5 * self.0.bulk * trial.dilation * trial.dilation + self.0.mu * dev
    }

    fn history(&self) -> usize {
        7
    }

    fn advance(&self, state: &StrainState<'_, S>, history: &mut [f64]) {
        let trial = self.trial(state);
        let alpha = remembered(state.history).1 + trial.turn.delta;
        let share = trial.dev.map(|e| (2.0 * (trial.turn.kept - 1.0) * e).exp());
        let g = congruent(&trial.axes, &Tensor::from_diagonal(&share.into()));
        remember(&(g - IDENTITY), alpha, history);
    }

    /// The plastic strain is ½ ln C_p.
    fn internal(&self, state: &StrainState<'_, S>, variable: &str, out: &mut Vec<f64>) -> bool {
        if let "UNIAXIAL_STRESS" | PLASTIC_WORK = variable {
            let trial = self.trial(state);
            let dev: f64 = trial.dev.iter().map(|e| e * e).sum();
            let q = 2.0 * self.0.mu * trial.turn.kept * (1.5 * dev).sqrt();
            out.push(if variable == PLASTIC_WORK { q * trial.turn.delta } else { q });
            return true;
        }
        let (g, alpha) = remembered(state.history);
        let (values, vectors) = eigen(&(IDENTITY + g));
        let plastic = congruent(&vectors, &Tensor::from_diagonal(&values.map(|value| -0.5 * value.ln())));
        answer::<S>(&plastic, alpha, variable, out)
    }
}

/// Adds `factor` `a` ⊗ `b`.
fn add_dyad<const S: usize>(factor: f64, a: &[f64; S], b: &[f64; S], out: &mut Matrix<S>) {
    for (row, a) in out.iter_mut().zip(a) {
        row.iter_mut().zip(b).for_each(|(out, b)| *out += factor * (a * b));
    }
}

register! { LawEntry "FiniteStrainIsotropicPlasticity3DVonMisesVonMises",
    about: "Von Mises plasticity under finite strain for solids (multiplicative, logarithmic strain); properties as SmallStrainJ2Plasticity3DLaw",
    source: "τ = K tr(ε) 1 + 2μ dev ε, ε = ½ ln b_e; Simo, Computer Methods in Applied Mechanics and Engineering 99 (1992) 61–112",
    takes: hardening::CONSTANTS,
    build: LawFactory::Space(FiniteStrainPlasticity::boxed::<6>),
}

register! { LawEntry "FiniteStrainIsotropicPlasticityPlaneStrainVonMisesVonMises",
    about: "Von Mises plasticity under finite plane strain; properties as SmallStrainJ2Plasticity3DLaw",
    source: "τ = K tr(ε) 1 + 2μ dev ε, ε = ½ ln b_e, F_zz = 1",
    takes: hardening::CONSTANTS,
    build: LawFactory::PlaneStrain { plane: FiniteStrainPlasticity::boxed::<3>, whole: FiniteStrainPlasticity::boxed::<4> },
}

register! { LawEntry "FiniteStrainIsotropicPlasticityAxisymVonMisesVonMises",
    about: "Von Mises plasticity under finite strain with axial symmetry; properties as SmallStrainJ2Plasticity3DLaw",
    source: "τ = K tr(ε) 1 + 2μ dev ε, ε = ½ ln b_e on (rr, zz, tt, rz)",
    takes: hardening::CONSTANTS,
    build: LawFactory::Axisymmetric(FiniteStrainPlasticity::boxed::<4>),
}
