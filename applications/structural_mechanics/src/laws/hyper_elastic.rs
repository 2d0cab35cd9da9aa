//! Compressible neo-Hooke material.
//!
//! W = ½ λ ln²J − μ ln J + ½ μ (tr C − 3); S = μ (1 − C⁻¹) + λ ln J C⁻¹;
//! D_ijkl = λ C⁻¹_ij C⁻¹_kl + (μ − λ ln J)(C⁻¹_ik C⁻¹_jl + C⁻¹_il C⁻¹_jk).
//! In the plane C_zz = 1. A small-displacement element gives C = 1 + 2ε and J = det(1 + ε), as in Kratos; the first term of
//! D is then λ C⁻¹ ⊗ (1 + ε)⁻¹, which is not symmetric.

use crate::laws::LawEntry;
use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;
use zelus_core::register;

use super::elastic::Elasticity;
use super::law::{ConstitutiveLaw, LawFactory, Matrix, StrainState};
use crate::tensor::{IDENTITY, Tensor, inverse, pairs, strain_tensor};

/// Compressible neo-Hooke law.
#[derive(Debug, Clone, PartialEq)]
pub struct HyperElastic {
    /// First Lamé constant λ.
    pub lambda: f64,
    /// Shear modulus μ.
    pub mu: f64,
}

/// C = 1 + 2E.
pub(super) fn right_cauchy_green<const S: usize>(state: &StrainState<'_, S>) -> Tensor {
    IDENTITY + 2.0 * strain_tensor(&state.strain)
}

impl<const S: usize> ConstitutiveLaw<S> for HyperElastic {
    fn pk2(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        let (pairs, k) = (pairs::<S>(), inverse(&right_cauchy_green(state)));
        let pressure = self.lambda * state.det_f.ln();
        let volume = if state.small { inverse(&state.f) } else { k };
        if let Some(tangent) = tangent {
            for (row, (i, j)) in tangent.iter_mut().zip(pairs) {
                for (entry, (p, q)) in row.iter_mut().zip(pairs) {
                    *entry = self.lambda * k[(i, j)] * volume[(p, q)]
                        + (self.mu - pressure) * (k[(i, p)] * k[(j, q)] + k[(i, q)] * k[(j, p)]);
                }
            }
        }
        pairs.map(|(i, j)| self.mu * (IDENTITY[(i, j)] - k[(i, j)]) + pressure * k[(i, j)])
    }

    fn is_symmetric(&self, small: bool) -> bool {
        !small
    }

    fn energy(&self, state: &StrainState<'_, S>) -> f64 {
        let (c, log) = (right_cauchy_green(state), state.det_f.ln());
        0.5 * self.lambda * log * log - self.mu * log + 0.5 * self.mu * (c.trace() - 3.0)
    }
}

fn neo_hooke<const S: usize>(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<S>>> {
    let material = Elasticity::of(properties)?;
    Ok(Box::new(HyperElastic { lambda: material.lambda(), mu: material.mu() }))
}

register! { LawEntry "HyperElastic3DLaw",
    about: "Compressible neo-Hooke material for solids; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "W = ½ λ ln²J − μ ln J + ½ μ (tr C − 3)",
    build: LawFactory::Space(neo_hooke::<6>),
}

register! { LawEntry "HyperElasticPlaneStrain2DLaw",
    about: "Compressible neo-Hooke material in plane strain; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "W = ½ λ ln²J − μ ln J + ½ μ (tr C − 3) with C_zz = 1",
    build: LawFactory::PlaneStrain { plane: neo_hooke::<3>, whole: neo_hooke::<4> },
}

register! { LawEntry "HyperElasticAxisym2DLaw",
    about: "Compressible neo-Hooke material with axial symmetry; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "W = ½ λ ln²J − μ ln J + ½ μ (tr C − 3) on (rr, zz, tt, rz)",
    build: LawFactory::Axisymmetric(neo_hooke::<4>),
}
