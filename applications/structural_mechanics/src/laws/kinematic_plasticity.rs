//! Von Mises plasticity with kinematic and isotropic hardening under small strain.
//!
//! σ = K tr(ε) 1 + 2μ dev(ε − ε_p), √(3/2) ‖dev σ − β‖ ≤ σ_y(α), with the back stress β of [`super::kinematic_hardening`]. The return
//! s = s_tr − √6 μ Δp n is along n = (s_tr − θ β_n)/‖…‖. With a = √6 μ Δp/‖…‖, h = √(3/2)/slope and the part b of β_n across n,
//!
//! ds = (1 − a) ds_tr − ((√6 μ h − a) n + a γ θ² h b)(n · ds_tr),  ds_tr = 2μ dev dε.
//!
//! With γ > 0 this is not symmetric. In elements of finite deformation ε is Green–Lagrange's and σ the second Piola–Kirchhoff stress: for
//! small strains, large rotations.
//!
//! The history of a point is ε_p and β (tensor components xx yy zz xy yz xz each) and α.

use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;
use zelus_core::register;

use super::j2::J2;
use super::kinematic_hardening::{self, KinematicHardening, KinematicReturn};
use super::law::{ConstitutiveLaw, LawEntry, LawFactory, Matrix, StrainState};
use super::small_strain_plasticity::{PLASTIC_WORK, answer};
use crate::tensor::{Tensor, deviator, pairs, strain_tensor, stress_tensor, stress_vector};

/// Von Mises plasticity with combined hardening under small strain.
#[derive(Debug, Clone, PartialEq)]
pub struct KinematicPlasticity {
    /// Elasticity and isotropic hardening.
    pub j2: J2,
    /// Kinematic hardening.
    pub kinematic: KinematicHardening,
}

/// Plastic strain, back stress and equivalent plastic strain.
struct Remembered {
    plastic: Tensor,
    back: Tensor,
    alpha: f64,
}

/// A trial state and its return.
struct KinematicTrial {
    before: Remembered,
    /// tr ε.
    dilation: f64,
    turn: KinematicReturn,
    /// Deviator of the stress.
    s: Tensor,
}

fn remembered(history: &[f64]) -> Remembered {
    let (parts, rest) = history.as_chunks::<6>();
    let (&[plastic, back], &[alpha]) = (parts, rest) else { unreachable!("combined hardening remembers 13 numbers") };
    Remembered { plastic: stress_tensor(&plastic), back: stress_tensor(&back), alpha }
}

impl KinematicPlasticity {
    fn trial<const S: usize>(&self, state: &StrainState<'_, S>) -> KinematicTrial {
        let before = remembered(state.history);
        let strain = strain_tensor(&state.strain);
        let trial = 2.0 * self.j2.mu * (deviator(&strain) - before.plastic);
        let turn = if state.elastic {
            KinematicReturn::NONE
        } else {
            self.kinematic.turn_back(&self.j2, &trial, &before.back, before.alpha)
        };
        let s = trial - 6.0_f64.sqrt() * self.j2.mu * turn.delta * turn.normal;
        KinematicTrial { before, dilation: strain.trace(), turn, s }
    }

    /// The von Mises stress of the deviator less the back stress, after the step.
    fn equivalent_stress(&self, trial: &KinematicTrial) -> f64 {
        let back = self.kinematic.moved(&trial.before.back, &trial.turn);
        1.5_f64.sqrt() * (trial.s - back).norm()
    }

    fn boxed<const S: usize>(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<S>>> {
        Ok(Box::new(Self { j2: J2::of(properties)?, kinematic: KinematicHardening::of(properties)? }))
    }
}

impl<const S: usize> ConstitutiveLaw<S> for KinematicPlasticity {
    fn pk2(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        let KinematicTrial { before, dilation, turn, s, .. } = self.trial(state);
        let (pairs, unit) = (pairs::<S>(), |p, q| if p == q { 1.0 } else { 0.0 });
        if let Some(tangent) = tangent {
            let two_mu = 2.0 * self.j2.mu;
            let stiff = 6.0_f64.sqrt() * self.j2.mu;
            let (kept, along) = if turn.delta > 0.0 {
                let lost = stiff * turn.delta / turn.size;
                let reach = 1.5_f64.sqrt() / turn.slope;
                let across = before.back - before.back.dot(&turn.normal) * turn.normal;
                let turning = lost * self.kinematic.rate * turn.recall * turn.recall * reach;
                (1.0 - lost, (stiff * reach - lost) * turn.normal + turning * across)
            } else {
                (1.0, Tensor::zeros())
            };
            for (row, (i, j)) in tangent.iter_mut().zip(pairs) {
                for (entry, (p, q)) in row.iter_mut().zip(pairs) {
                    let symmetric = 0.5 * (unit(i, p) * unit(j, q) + unit(i, q) * unit(j, p));
                    let volume = unit(i, j) * unit(p, q);
                    *entry = self.j2.bulk * volume
                        + two_mu * (kept * (symmetric - volume / 3.0) - along[(i, j)] * turn.normal[(p, q)]);
                }
            }
        }
        pairs.map(|(i, j)| self.j2.bulk * dilation * unit(i, j) + s[(i, j)])
    }

    /// The elastic part: ½ K tr²(ε) + ‖dev σ‖²/4μ.
    fn energy(&self, state: &StrainState<'_, S>) -> f64 {
        let KinematicTrial { dilation, s, .. } = self.trial(state);
        0.5 * self.j2.bulk * dilation * dilation + s.norm_squared() / (4.0 * self.j2.mu)
    }

    fn is_symmetric(&self, _small: bool) -> bool {
        self.kinematic.rate == 0.0
    }

    fn ignores_measure(&self, small: bool) -> bool {
        small
    }

    fn history(&self) -> usize {
        13
    }

    fn advance(&self, state: &StrainState<'_, S>, history: &mut [f64]) {
        let KinematicTrial { before, turn, .. } = self.trial(state);
        let plastic = before.plastic + 1.5_f64.sqrt() * turn.delta * turn.normal;
        history[..6].copy_from_slice(&stress_vector::<6>(&plastic));
        history[6..12].copy_from_slice(&stress_vector::<6>(&self.kinematic.moved(&before.back, &turn)));
        history[12] = before.alpha + turn.delta;
    }

    fn internal(&self, state: &StrainState<'_, S>, variable: &str, out: &mut Vec<f64>) -> bool {
        match variable {
            "UNIAXIAL_STRESS" => {
                out.push(self.equivalent_stress(&self.trial(state)));
            }
            PLASTIC_WORK => {
                let trial = self.trial(state);
                out.push(1.5_f64.sqrt() * trial.turn.delta * trial.s.dot(&trial.turn.normal));
            }
            "BACK_STRESS_VECTOR" => out.extend_from_slice(&stress_vector::<S>(&remembered(state.history).back)),
            _ => {
                let Remembered { plastic, alpha, .. } = remembered(state.history);
                return answer::<S>(&plastic, alpha, variable, out);
            }
        }
        true
    }
}

register! { LawEntry "SmallStrainKinematicPlasticity3DVonMisesVonMises",
    about: "Von Mises plasticity with combined hardening under small strain for solids; needs KINEMATIC_HARDENING_TYPE 0 (linear) or 1 (Armstrong–Frederick), KINEMATIC_PLASTICITY_PARAMETERS [C] or [C, γ], and properties of SmallStrainJ2Plasticity3DLaw",
    source: "√(3/2) ‖dev σ − β‖ ≤ σ_y(α), β̇ = ⅔ C ε̇_p − γ β ṗ; Armstrong and Frederick, CEGB report RD/B/N 731 (1966)",
    takes: kinematic_hardening::CONSTANTS,
    build: LawFactory::Space(KinematicPlasticity::boxed::<6>),
}

register! { LawEntry "SmallStrainKinematicPlasticityPlaneStrainVonMisesVonMises",
    aliases: &["SmallStrainKinematicPlasticitypePlaneStrainVonMisesVonMises"],
    about: "Von Mises plasticity with combined hardening under small plane strain; properties as SmallStrainKinematicPlasticity3DVonMisesVonMises",
    source: "√(3/2) ‖dev σ − β‖ ≤ σ_y(α), β̇ = ⅔ C ε̇_p − γ β ṗ with ε_zz = 0",
    takes: kinematic_hardening::CONSTANTS,
    build: LawFactory::PlaneStrain { plane: KinematicPlasticity::boxed::<3>, whole: KinematicPlasticity::boxed::<4> },
}

register! { LawEntry "SmallStrainKinematicPlasticityAxisymVonMisesVonMises",
    about: "Von Mises plasticity with combined hardening under small strain with axial symmetry; properties as SmallStrainKinematicPlasticity3DVonMisesVonMises",
    source: "√(3/2) ‖dev σ − β‖ ≤ σ_y(α), β̇ = ⅔ C ε̇_p − γ β ṗ on (rr, zz, tt, rz)",
    takes: kinematic_hardening::CONSTANTS,
    build: LawFactory::Axisymmetric(KinematicPlasticity::boxed::<4>),
}
