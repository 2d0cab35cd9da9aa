//! Hooke's law, stress = D · strain, whatever the measures of strain and stress.
//!
//! In elements of finite deformation the strain is Green–Lagrange's and the result serves as second Piola–Kirchhoff
//! stress (total Lagrangian) or, without push-forward, as Cauchy stress (updated Lagrangian), as in Kratos. Prefer
//! Kirchhoff–Saint-Venant there.

use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;
use zelus_core::register;
use zelus_core::registry::Build;

use super::elastic::{Elasticity, multiply, quadratic_energy};
use super::law::{ConstitutiveLaw, LawFactory, Matrix, StrainState};

/// Linear elastic law with a constant matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearElastic<const S: usize> {
    /// The matrix D.
    pub d: Matrix<S>,
}

impl<const S: usize> ConstitutiveLaw<S> for LinearElastic<S> {
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

    fn ignores_measure(&self) -> bool {
        true
    }
}

fn hooke<const S: usize>(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<S>>> {
    Ok(Box::new(LinearElastic { d: Elasticity::of(properties)?.hooke::<S>() }))
}

fn plane_stress(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<3>>> {
    Ok(Box::new(LinearElastic { d: Elasticity::of(properties)?.plane_stress() }))
}

register! { ConstitutiveLaw "LinearElastic3DLaw",
    about: "Hooke's law for solids; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "σ = λ tr(ε) 1 + 2μ ε",
    build: Build::Factory(&LawFactory::<6>(hooke::<6>)),
}

register! { ConstitutiveLaw "LinearElasticPlaneStrain2DLaw",
    about: "Hooke's law in plane strain; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "σ = λ tr(ε) 1 + 2μ ε with ε_zz = 0",
    build: Build::Factory(&LawFactory::<3>(hooke::<3>)),
}

register! { ConstitutiveLaw "LinearElasticPlaneStress2DLaw",
    about: "Hooke's law in plane stress; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "σ = λ tr(ε) 1 + 2μ ε with σ_zz = 0",
    build: Build::Factory(&LawFactory::<3>(plane_stress)),
}

register! { ConstitutiveLaw "LinearElasticAxisym2DLaw",
    about: "Hooke's law with axial symmetry; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "σ = λ tr(ε) 1 + 2μ ε on (rr, zz, tt, rz)",
    build: Build::Factory(&LawFactory::<4>(hooke::<4>)),
}
