//! Linear viscoelasticity: Hooke's law whose deviator relaxes by a Prony series ([`super::prony`]).
//!
//! σ = K tr(ε) 1 + s, s the relaxed 2μ dev ε: YOUNG_MODULUS and POISSON_RATIO are instantaneous. In elements of finite deformation ε is
//! Green–Lagrange's and σ the second Piola–Kirchhoff stress.

use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;
use zelus_core::register;

use super::elastic::Elasticity;
use super::law::{ConstitutiveLaw, LawEntry, LawFactory, Matrix, StrainState};
use super::prony::{self, PronySeries, Relaxation};
use crate::tensor::{IDENTITY, Tensor, deviator, pairs, strain_tensor};

/// Hooke's law with a relaxing deviator.
#[derive(Debug, Clone, PartialEq)]
pub struct SmallStrainViscoelasticity {
    mu: f64,
    bulk: f64,
    series: PronySeries,
}

impl SmallStrainViscoelasticity {
    fn boxed<const S: usize>(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<S>>> {
        let elasticity = Elasticity::of(properties)?;
        let (mu, series) = (elasticity.mu(), PronySeries::required(properties)?);
        Ok(Box::new(Self { mu, bulk: elasticity.lambda() + 2.0 / 3.0 * mu, series }))
    }

    /// 2μ dev ε and the step.
    fn step<const S: usize>(&self, state: &StrainState<'_, S>) -> (Tensor, Relaxation) {
        let elastic = 2.0 * self.mu * deviator(&strain_tensor(&state.strain));
        (elastic, self.series.step(state.history, state.step, state.elastic))
    }
}

impl<const S: usize> ConstitutiveLaw<S> for SmallStrainViscoelasticity {
    fn pk2(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        let (elastic, Relaxation { factor, remembered }) = self.step(state);
        let pairs = pairs::<S>();
        if let Some(tangent) = tangent {
            for (row, (i, j)) in tangent.iter_mut().zip(pairs) {
                for (entry, (p, q)) in row.iter_mut().zip(pairs) {
                    let symmetric = 0.5 * (IDENTITY[(i, p)] * IDENTITY[(j, q)] + IDENTITY[(i, q)] * IDENTITY[(j, p)]);
                    let volume = IDENTITY[(i, j)] * IDENTITY[(p, q)];
                    *entry = self.bulk * volume + 2.0 * self.mu * factor * (symmetric - volume / 3.0);
                }
            }
        }
        let stress = factor * elastic + remembered + self.bulk * strain_tensor(&state.strain).trace() * IDENTITY;
        pairs.map(|pair| stress[pair])
    }

    /// That of the instantaneous elasticity.
    fn energy(&self, state: &StrainState<'_, S>) -> f64 {
        let strain = strain_tensor(&state.strain);
        0.5 * self.bulk * strain.trace() * strain.trace() + self.mu * deviator(&strain).norm_squared()
    }

    fn depends_on_time(&self) -> bool {
        true
    }

    fn ignores_measure(&self, small: bool) -> bool {
        small
    }

    fn history(&self) -> usize {
        self.series.history()
    }

    fn advance(&self, state: &StrainState<'_, S>, history: &mut [f64]) {
        self.series.advance(&self.step(state).0, state.step, state.elastic, history);
    }
}

register! { LawEntry "SmallStrainViscoelasticity3D",
    about: "Linear viscoelasticity for solids: the deviator relaxes; needs YOUNG_MODULUS, POISSON_RATIO (instantaneous), PRONY_SHARES, PRONY_TIMES",
    source: "s = ∫ 2μ (1 − Σ g_i (1 − exp(−(t − s)/τ_i))) d(dev ε); Simo and Hughes, Computational Inelasticity, § 10.1",
    takes: &prony::CONSTANTS,
    build: LawFactory::Space(SmallStrainViscoelasticity::boxed::<6>),
}

register! { LawEntry "SmallStrainViscoelasticityPlaneStrain",
    about: "Linear viscoelasticity in plane strain; constants of SmallStrainViscoelasticity3D",
    source: "s = ∫ 2μ (1 − Σ g_i (1 − exp(−(t − s)/τ_i))) d(dev ε) with ε_zz = 0",
    takes: &prony::CONSTANTS,
    build: LawFactory::PlaneStrain {
        plane: SmallStrainViscoelasticity::boxed::<3>,
        whole: SmallStrainViscoelasticity::boxed::<4>,
    },
}

register! { LawEntry "SmallStrainViscoelasticityAxisym",
    about: "Linear viscoelasticity with axial symmetry; constants of SmallStrainViscoelasticity3D",
    source: "s = ∫ 2μ (1 − Σ g_i (1 − exp(−(t − s)/τ_i))) d(dev ε) on (rr, zz, tt, rz)",
    takes: &prony::CONSTANTS,
    build: LawFactory::Axisymmetric(SmallStrainViscoelasticity::boxed::<4>),
}
