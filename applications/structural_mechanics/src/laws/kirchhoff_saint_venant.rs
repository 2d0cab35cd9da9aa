//! Kirchhoff–Saint-Venant: Hooke's law between Green–Lagrange strain and second Piola–Kirchhoff stress.
//!
//! S = D E; Cauchy stress F S Fᵀ / det F. Weakens and fails in strong compression.

use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;
use zelus_core::register;
use zelus_core::registry::Build;

use super::elastic::{Elasticity, multiply, quadratic_energy};
use super::law::{ConstitutiveLaw, LawFactory, Matrix, StrainState};
use crate::tensor::{congruent, inverse, strain_tensor, strain_vector, transposed};

/// Kirchhoff–Saint-Venant law with a constant matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct KirchhoffSaintVenant<const S: usize> {
    /// The matrix D.
    pub d: Matrix<S>,
}

impl<const S: usize> ConstitutiveLaw<S> for KirchhoffSaintVenant<S> {
    fn pk2(&self, state: &StrainState<S>, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        if let Some(tangent) = tangent {
            *tangent = self.d;
        }
        multiply(&self.d, &state.strain)
    }

    fn energy(&self, state: &StrainState<S>) -> f64 {
        quadratic_energy(&self.d, &state.strain)
    }

    fn is_linear(&self) -> bool {
        true
    }

    /// e = F⁻ᵀ E F⁻¹.
    fn almansi(&self, state: &StrainState<S>) -> [f64; S] {
        strain_vector(&congruent(&transposed(&inverse(&state.f)), &strain_tensor(&state.strain)))
    }
}

fn hooke<const S: usize>(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<S>>> {
    Ok(Box::new(KirchhoffSaintVenant { d: Elasticity::of(properties)?.hooke::<S>() }))
}

fn plane_stress(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<3>>> {
    Ok(Box::new(KirchhoffSaintVenant { d: Elasticity::of(properties)?.plane_stress() }))
}

register! { ConstitutiveLaw "KirchhoffSaintVenant3DLaw",
    about: "Kirchhoff–Saint-Venant for solids; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "S = λ tr(E) 1 + 2μ E",
    build: Build::Factory(&LawFactory::<6>(hooke::<6>)),
}

register! { ConstitutiveLaw "KirchhoffSaintVenantPlaneStrain2DLaw",
    about: "Kirchhoff–Saint-Venant in plane strain; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "S = λ tr(E) 1 + 2μ E with E_zz = 0",
    build: Build::Factory(&LawFactory::<3>(hooke::<3>)),
}

register! { ConstitutiveLaw "KirchhoffSaintVenantPlaneStress2DLaw",
    about: "Kirchhoff–Saint-Venant in plane stress; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "S = λ tr(E) 1 + 2μ E with S_zz = 0",
    build: Build::Factory(&LawFactory::<3>(plane_stress)),
}

register! { ConstitutiveLaw "KirchhoffSaintVenantAxisym2DLaw",
    about: "Kirchhoff–Saint-Venant with axial symmetry; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "S = λ tr(E) 1 + 2μ E on (rr, zz, tt, rz)",
    build: Build::Factory(&LawFactory::<4>(hooke::<4>)),
}
