//! Kirchhoff–Saint-Venant: Hooke's law between Green–Lagrange strain and second Piola–Kirchhoff stress.
//!
//! S = D E; Cauchy stress F S Fᵀ / det F. Weakens and fails in strong compression.

use zelus_core::register;
use zelus_core::registry::Build;

use super::hooke::Hooke;
use super::law::{LawFactory, PlaneStrainFactory};

/// Kirchhoff–Saint-Venant law with a constant matrix.
pub type KirchhoffSaintVenant<const S: usize> = Hooke<S, true>;

register! { ConstitutiveLaw "KirchhoffSaintVenant3DLaw",
    about: "Kirchhoff–Saint-Venant for solids; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "S = λ tr(E) 1 + 2μ E",
    build: Build::Factory(&LawFactory::<6>(KirchhoffSaintVenant::<6>::boxed)),
}

register! { ConstitutiveLaw "KirchhoffSaintVenantPlaneStrain2DLaw",
    about: "Kirchhoff–Saint-Venant in plane strain; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "S = λ tr(E) 1 + 2μ E with E_zz = 0",
    build: Build::Factory(&PlaneStrainFactory::new(KirchhoffSaintVenant::<3>::boxed, KirchhoffSaintVenant::<4>::boxed)),
}

register! { ConstitutiveLaw "KirchhoffSaintVenantPlaneStress2DLaw",
    about: "Kirchhoff–Saint-Venant in plane stress; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "S = λ tr(E) 1 + 2μ E with S_zz = 0",
    build: Build::Factory(&LawFactory::<3>(KirchhoffSaintVenant::plane_stress)),
}

register! { ConstitutiveLaw "KirchhoffSaintVenantAxisym2DLaw",
    about: "Kirchhoff–Saint-Venant with axial symmetry; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "S = λ tr(E) 1 + 2μ E on (rr, zz, tt, rz)",
    build: Build::Factory(&LawFactory::<4>(KirchhoffSaintVenant::<4>::boxed)),
}
