//! Norton's creep under small strain: ε̇_c = A q^n t^m · 3/2 s/q with the deviator s and the von Mises stress q of the stress.
//!
//! σ = K tr(ε) 1 + 2μ dev(ε − ε_c). A step is implicit in the stress and exact in the time: q + 3μ a q^n = q_tr with the trial value
//! q_tr and a = A (t₁^(m+1) − t₀^(m+1))/(m + 1). The deviator shrinks to its k-th part, k = q/q_tr; with r = dq/dq_tr the tangent is
//! D = K 1⊗1 + 2μ (k (I − 1⊗1/3) + (r − k) n⊗n). Time hardening (m < 0) counts from TIME 0. A, and Young's modulus, may follow tables over
//! TEMPERATURE. In elements of finite deformation ε is Green–Lagrange's and σ the second Piola–Kirchhoff stress.
//!
//! The history of a point is ε_c (tensor components xx yy zz xy yz xz), the equivalent creep strain, whether a step has been accepted,
//! and its TIME: the creep of a step that is accepted counts once.

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::Properties;
use zelus_core::register;

use super::elastic::Elasticity;
use super::law::{ConstitutiveLaw, LawEntry, LawFactory, Matrix, StrainState};
use super::quantity::Quantity;
use super::small_strain_plasticity::{PLASTIC_WORK, remember, remembered};
use crate::tensor::{Tensor, deviator, pairs, strain_tensor, strain_vector};

/// Norton's creep.
#[derive(Debug, Clone, PartialEq)]
pub struct NortonCreep {
    young: Quantity,
    poisson: f64,
    /// A.
    coefficient: Quantity,
    /// n.
    exponent: f64,
    /// m.
    time_exponent: f64,
}

/// Constants that laws of creep take.
const CONSTANTS: &[&str] = &["NORTON_COEFFICIENT", "NORTON_EXPONENT", "NORTON_TIME_EXPONENT"];

/// A step from its trial state.
struct CreepTrial {
    bulk: f64,
    mu: f64,
    dilation: f64,
    /// Trial deviator of the stress.
    s: Tensor,
    /// q.
    equivalent: f64,
    /// k.
    kept: f64,
    /// r.
    slope: f64,
    /// Growth of the equivalent creep strain.
    growth: f64,
}

/// The root q of q + 3μ a q^n = q_tr, dq/dq_tr and 3μ a q^n; `stiff` is 3μ a.
///
/// The left side is convex for n ≥ 1: Newton's iteration falls to the root from any point above it.
fn equivalent_stress(trial: f64, stiff: f64, exponent: f64) -> [f64; 3] {
    if trial <= 0.0 || stiff <= 0.0 {
        // from the state without stress a linear law creeps at once, the others do not
        let slope = if exponent == 1.0 { 1.0 / (1.0 + stiff) } else { 1.0 };
        return [trial, slope, 0.0];
    }
    let mut q = trial.min((trial / stiff).powf(exponent.recip()));
    for _ in 0..200 {
        let creep = stiff * q.powf(exponent);
        let excess = q + creep - trial;
        let next = q - excess * q / (q + exponent * creep);
        if excess <= 1e-15 * trial || next >= q || next.is_nan() {
            break;
        }
        q = next;
    }
    let creep = stiff * q.powf(exponent);
    [q, q / (q + exponent * creep), creep]
}

impl NortonCreep {
    /// # Errors
    /// Constants that are missing or out of range.
    fn new(properties: &Properties) -> Result<Self> {
        let Elasticity { poisson, .. } = Elasticity::of(properties)?;
        let exponent = properties.require("NORTON_EXPONENT")?;
        let time_exponent = properties.number("NORTON_TIME_EXPONENT").unwrap_or(0.0);
        let problem = |name: &str, value: f64, remedy: &str| {
            Diagnostic::error("material-out-of-range", format!("{name} of properties {} is {value}", properties.id))
                .at(properties.place.clone())
                .remedy(remedy.to_owned())
        };
        if !(exponent >= 1.0 && exponent.is_finite()) {
            return Err(problem("NORTON_EXPONENT", exponent, "give a number from 1").into());
        }
        if !(time_exponent > -1.0 && time_exponent.is_finite()) {
            return Err(
                problem("NORTON_TIME_EXPONENT", time_exponent, "give a number above -1; 0 is steady creep").into()
            );
        }
        Ok(Self {
            young: Quantity::positive(properties, "YOUNG_MODULUS")?,
            poisson,
            coefficient: Quantity::positive(properties, "NORTON_COEFFICIENT")?,
            exponent,
            time_exponent,
        })
    }

    fn boxed<const S: usize>(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<S>>> {
        Ok(Box::new(Self::new(properties)?))
    }

    /// a: the creep of the step at the unit stress.
    fn creep<const S: usize>(&self, state: &StrainState<'_, S>) -> f64 {
        if state.elastic {
            return 0.0;
        }
        let [begin, end] = state.step;
        let begin = if state.history[7] > 0.0 { state.history[8] } else { begin };
        let grown = if self.time_exponent == 0.0 {
            end - begin
        } else {
            let power = self.time_exponent + 1.0;
            (end.max(0.0).powf(power) - begin.max(0.0).powf(power)) / power
        };
        self.coefficient.at(state.temperature) * grown.max(0.0)
    }

    fn trial<const S: usize>(&self, state: &StrainState<'_, S>) -> CreepTrial {
        let elasticity = Elasticity { young: self.young.at(state.temperature), poisson: self.poisson };
        let mu = elasticity.mu();
        let strain = strain_tensor(&state.strain);
        let s = 2.0 * mu * (deviator(&strain) - remembered(&state.history[..7]).0);
        let trial = 1.5_f64.sqrt() * s.norm();
        let [equivalent, slope, creep] = equivalent_stress(trial, 3.0 * mu * self.creep(state), self.exponent);
        let kept = if trial > 0.0 { equivalent / trial } else { slope };
        let bulk = elasticity.lambda() + 2.0 / 3.0 * mu;
        CreepTrial { bulk, mu, dilation: strain.trace(), s, equivalent, kept, slope, growth: creep / (3.0 * mu) }
    }
}

impl<const S: usize> ConstitutiveLaw<S> for NortonCreep {
    fn pk2(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        let CreepTrial { bulk, mu, dilation, s, kept, slope, .. } = self.trial(state);
        let (pairs, unit) = (pairs::<S>(), |p, q| if p == q { 1.0 } else { 0.0 });
        if let Some(tangent) = tangent {
            let square = s.norm_squared();
            let along = if square > 0.0 { 2.0 * mu * (slope - kept) / square } else { 0.0 };
            for (row, (i, j)) in tangent.iter_mut().zip(pairs) {
                for (entry, (p, q)) in row.iter_mut().zip(pairs) {
                    let symmetric = 0.5 * (unit(i, p) * unit(j, q) + unit(i, q) * unit(j, p));
                    let volume = unit(i, j) * unit(p, q);
                    *entry =
                        bulk * volume + 2.0 * mu * kept * (symmetric - volume / 3.0) + along * (s[(i, j)] * s[(p, q)]);
                }
            }
        }
        pairs.map(|(i, j)| bulk * dilation * unit(i, j) + kept * s[(i, j)])
    }

    /// The elastic part: ½ K tr²(ε) + q²/6μ.
    fn energy(&self, state: &StrainState<'_, S>) -> f64 {
        let CreepTrial { bulk, mu, dilation, equivalent, .. } = self.trial(state);
        0.5 * bulk * dilation * dilation + equivalent * equivalent / (6.0 * mu)
    }

    fn expands(&self) -> bool {
        self.young.varies() || self.coefficient.varies()
    }

    fn depends_on_time(&self) -> bool {
        true
    }

    fn ignores_measure(&self, small: bool) -> bool {
        small
    }

    fn history(&self) -> usize {
        9
    }

    fn advance(&self, state: &StrainState<'_, S>, history: &mut [f64]) {
        let trial = self.trial(state);
        let (mut strain, equivalent) = remembered(&state.history[..7]);
        let size = trial.s.norm();
        if size > 0.0 {
            strain += (1.5_f64.sqrt() * trial.growth / size) * trial.s;
        }
        remember(&strain, equivalent + trial.growth, history);
        if !state.elastic {
            history[7..].copy_from_slice(&[1.0, state.step[1]]);
        }
    }

    fn internal(&self, state: &StrainState<'_, S>, variable: &str, out: &mut Vec<f64>) -> bool {
        let (strain, equivalent) = remembered(&state.history[..7]);
        match variable {
            "EQUIVALENT_CREEP_STRAIN" => out.push(equivalent),
            "CREEP_STRAIN_VECTOR" => out.extend_from_slice(&strain_vector::<S>(&strain)),
            "UNIAXIAL_STRESS" => out.push(self.trial(state).equivalent),
            PLASTIC_WORK => {
                let trial = self.trial(state);
                out.push(trial.equivalent * trial.growth);
            }
            _ => return false,
        }
        true
    }
}

register! { LawEntry "SmallStrainNortonCreep3D",
    about: "Norton's creep under small strain for solids; needs YOUNG_MODULUS, POISSON_RATIO, NORTON_COEFFICIENT A, NORTON_EXPONENT n; takes NORTON_TIME_EXPONENT m; reads tables over TEMPERATURE",
    source: "ε̇_c = 3/2 A q^(n−1) t^m s; Norton, The Creep of Steel at High Temperatures (1929)",
    takes: CONSTANTS,
    build: LawFactory::Space(NortonCreep::boxed::<6>),
}

register! { LawEntry "SmallStrainNortonCreepPlaneStrain",
    about: "Norton's creep under small plane strain; constants of SmallStrainNortonCreep3D",
    source: "ε̇_c = 3/2 A q^(n−1) t^m s with ε_zz = 0",
    takes: CONSTANTS,
    build: LawFactory::PlaneStrain { plane: NortonCreep::boxed::<3>, whole: NortonCreep::boxed::<4> },
}

register! { LawEntry "SmallStrainNortonCreepAxisym",
    about: "Norton's creep under small strain with axial symmetry; constants of SmallStrainNortonCreep3D",
    source: "ε̇_c = 3/2 A q^(n−1) t^m s on (rr, zz, tt, rz)",
    takes: CONSTANTS,
    build: LawFactory::Axisymmetric(NortonCreep::boxed::<4>),
}
