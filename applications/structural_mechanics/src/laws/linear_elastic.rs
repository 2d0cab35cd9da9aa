//! Hooke's law whatever the measures of strain and stress: the `LinearElastic` family.
//!
//! In elements of finite deformation the strain is Green–Lagrange's and the result serves as second Piola–Kirchhoff
//! stress (total Lagrangian) or, without push-forward, as Cauchy stress (updated Lagrangian), as in Kratos. Prefer
//! Kirchhoff–Saint-Venant there.

use crate::laws::LawEntry;
use zelus_core::register;

use super::hooke::Hooke;
use super::law::LawFactory;

/// Linear elastic law with a constant matrix.
pub type LinearElastic<const S: usize> = Hooke<S, false>;

register! { LawEntry "LinearElastic3DLaw",
    about: "Hooke's law for solids; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "σ = λ tr(ε) 1 + 2μ ε",
    build: LawFactory::Space(LinearElastic::<6>::boxed),
}

register! { LawEntry "LinearElasticPlaneStrain2DLaw",
    about: "Hooke's law in plane strain; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "σ = λ tr(ε) 1 + 2μ ε with ε_zz = 0",
    build: LawFactory::PlaneStrain { plane: LinearElastic::<3>::boxed, whole: LinearElastic::<4>::boxed },
}

register! { LawEntry "LinearElasticPlaneStress2DLaw",
    about: "Hooke's law in plane stress; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "σ = λ tr(ε) 1 + 2μ ε with σ_zz = 0",
    build: LawFactory::PlaneStress(LinearElastic::plane_stress),
}

register! { LawEntry "LinearElasticAxisym2DLaw",
    about: "Hooke's law with axial symmetry; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "σ = λ tr(ε) 1 + 2μ ε on (rr, zz, tt, rz)",
    build: LawFactory::Axisymmetric(LinearElastic::<4>::boxed),
}
