//! Isochoric neo-Hooke material: shape by the law, volume by the element.
//!
//! S = μ J^(−2/3) (1 − tr C/3 C⁻¹) − p J C⁻¹ with the pressure p (positive in compression) that the element holds constant;
//! κ = E/(3 (1 − 2ν)) is for the element, see [`crate::elements::TotalLagrangianQ1P0`].
//! dS/dE = μ J^(−2/3) (2/9 tr C K ⊗ K − 2/3 (1 ⊗ K + K ⊗ 1) + tr C/3 𝕂) − p J (K ⊗ K − 𝕂), K = C⁻¹,
//! 𝕂_ijkl = K_ik K_jl + K_il K_jk.

use crate::laws::LawEntry;
use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;
use zelus_core::register;

use super::elastic::Elasticity;
use super::hyper_elastic::right_cauchy_green;
use super::law::{ConstitutiveLaw, LawFactory, Matrix, StrainState};
use crate::tensor::{IDENTITY, inverse, pairs};

/// Isochoric neo-Hooke law.
#[derive(Debug, Clone, PartialEq)]
pub struct IsochoricNeoHooke {
    /// Shear modulus μ.
    pub mu: f64,
    /// Bulk modulus κ, for the element.
    pub bulk: f64,
}

impl IsochoricNeoHooke {
    fn boxed(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<6>>> {
        let material = Elasticity::of(properties)?;
        Ok(Box::new(Self { mu: material.mu(), bulk: material.young / (3.0 * (1.0 - 2.0 * material.poisson)) }))
    }
}

impl<const S: usize> ConstitutiveLaw<S> for IsochoricNeoHooke {
    fn pk2(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        let (pairs, c) = (pairs::<S>(), right_cauchy_green(state));
        let (k, third) = (inverse(&c), c.trace() / 3.0);
        let mu = self.mu * state.det_f.powf(-2.0 / 3.0);
        let volume = state.pressure * state.det_f;
        if let Some(tangent) = tangent {
            for (row, (i, j)) in tangent.iter_mut().zip(pairs) {
                for (entry, (p, q)) in row.iter_mut().zip(pairs) {
                    let (both, crossed) = (k[(i, j)] * k[(p, q)], k[(i, p)] * k[(j, q)] + k[(i, q)] * k[(j, p)]);
                    let mixed = IDENTITY[(i, j)] * k[(p, q)] + k[(i, j)] * IDENTITY[(p, q)];
                    *entry = mu * (2.0 / 3.0 * (third * both - mixed) + third * crossed) - volume * (both - crossed);
                }
            }
        }
        pairs.map(|(i, j)| mu * (IDENTITY[(i, j)] - third * k[(i, j)]) - volume * k[(i, j)])
    }

    /// Without the part of the volume, which is the element's.
    fn energy(&self, state: &StrainState<'_, S>) -> f64 {
        let c = right_cauchy_green(state);
        0.5 * self.mu * (state.det_f.powf(-2.0 / 3.0) * c.trace() - 3.0)
    }

    fn bulk_of_element(&self) -> Option<f64> {
        Some(self.bulk)
    }
}

register! { LawEntry "HyperElasticIsotropicQuasiIncompressibleIshochoricNeoHookean3D",
    about: "Isochoric neo-Hooke material for TotalLagrangianQ1P0MixedElement, which adds the pressure; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "W = ½ μ (J^(−2/3) tr C − 3), p by the element",
    build: LawFactory::Space(IsochoricNeoHooke::boxed),
}
