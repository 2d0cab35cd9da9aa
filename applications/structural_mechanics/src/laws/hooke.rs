//! Hooke's law, stress = D · strain, of the two families that use it.
//!
//! As `LinearElastic` (`PUSHED` false) the same numbers serve as every measure of strain and stress; as
//! `KirchhoffSaintVenant` (`PUSHED` true) S = D E is the second Piola–Kirchhoff stress and σ = F S Fᵀ / det F.

use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;

use super::elastic::{Elasticity, multiply, quadratic_energy};
use super::law::{ConstitutiveLaw, Matrix, StrainState};
use crate::tensor::{congruent, inverse, strain_tensor, strain_vector};

/// Linear law with a constant matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Hooke<const S: usize, const PUSHED: bool> {
    /// The matrix D.
    pub d: Matrix<S>,
}

impl<const S: usize, const PUSHED: bool> ConstitutiveLaw<S> for Hooke<S, PUSHED> {
    fn pk2(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        if let Some(tangent) = tangent {
            *tangent = self.d;
        }
        multiply(&self.d, &state.strain)
    }

    fn energy(&self, state: &StrainState<'_, S>) -> f64 {
        quadratic_energy(&self.d, &state.strain)
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn ignores_measure(&self, _small: bool) -> bool {
        !PUSHED
    }

    /// e = F⁻ᵀ E F⁻¹ where the law distinguishes measures.
    fn almansi(&self, state: &StrainState<'_, S>) -> [f64; S] {
        if !PUSHED {
            return state.strain;
        }
        strain_vector(&congruent(&inverse(&state.f).transpose(), &strain_tensor(&state.strain)))
    }
}

impl<const S: usize, const PUSHED: bool> Hooke<S, PUSHED> {
    /// The law of solids, axial symmetry and plane strain.
    ///
    /// # Errors
    /// As [`Elasticity::of`].
    pub(super) fn boxed(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<S>>> {
        Ok(Box::new(Self { d: Elasticity::of(properties)?.hooke::<S>() }))
    }
}

impl<const PUSHED: bool> Hooke<3, PUSHED> {
    /// The law of plane stress.
    ///
    /// # Errors
    /// As [`Elasticity::of`].
    pub(super) fn plane_stress(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<3>>> {
        Ok(Box::new(Self { d: Elasticity::of(properties)?.plane_stress() }))
    }
}
