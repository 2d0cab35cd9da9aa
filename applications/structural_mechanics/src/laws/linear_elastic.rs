//! Hooke's law whatever the measures of strain and stress: the `LinearElastic` family.
//!
//! In elements of finite deformation the strain is Green–Lagrange's and the result serves as second Piola–Kirchhoff
//! stress (total Lagrangian) or, without push-forward, as Cauchy stress (updated Lagrangian), as in Kratos. Prefer
//! Kirchhoff–Saint-Venant there.

use zelus_core::register;
use zelus_core::registry::Build;

use super::hooke::Hooke;
use super::law::{LawFactory, PlaneStrainFactory};

/// Linear elastic law with a constant matrix.
pub type LinearElastic<const S: usize> = Hooke<S, false>;

register! { ConstitutiveLaw "LinearElastic3DLaw",
    about: "Hooke's law for solids; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "σ = λ tr(ε) 1 + 2μ ε",
    build: Build::Factory(&LawFactory::<6>(LinearElastic::<6>::boxed)),
}

register! { ConstitutiveLaw "LinearElasticPlaneStrain2DLaw",
    about: "Hooke's law in plane strain; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "σ = λ tr(ε) 1 + 2μ ε with ε_zz = 0",
    build: Build::Factory(&PlaneStrainFactory::new(LinearElastic::<3>::boxed, LinearElastic::<4>::boxed)),
}

register! { ConstitutiveLaw "LinearElasticPlaneStress2DLaw",
    about: "Hooke's law in plane stress; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "σ = λ tr(ε) 1 + 2μ ε with σ_zz = 0",
    build: Build::Factory(&LawFactory::<3>(LinearElastic::plane_stress)),
}

register! { ConstitutiveLaw "LinearElasticAxisym2DLaw",
    about: "Hooke's law with axial symmetry; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "σ = λ tr(ε) 1 + 2μ ε on (rr, zz, tt, rz)",
    build: Build::Factory(&LawFactory::<4>(LinearElastic::<4>::boxed)),
}
