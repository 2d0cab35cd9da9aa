//! Kirchhoff–Saint-Venant: Hooke's law between Green–Lagrange strain and second Piola–Kirchhoff stress.
//!
//! S = D E; Cauchy stress F S Fᵀ / det F. Weakens and fails in strong compression.

use crate::laws::LawEntry;
use zelus_core::register;

use super::hooke::Hooke;
use super::law::LawFactory;

/// Kirchhoff–Saint-Venant law with a constant matrix.
pub type KirchhoffSaintVenant<const S: usize> = Hooke<S, true>;

register! { LawEntry "KirchhoffSaintVenant3DLaw",
    about: "Kirchhoff–Saint-Venant for solids; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "S = λ tr(E) 1 + 2μ E",
    build: LawFactory::Space(KirchhoffSaintVenant::<6>::boxed),
}

register! { LawEntry "KirchhoffSaintVenantPlaneStrain2DLaw",
    about: "Kirchhoff–Saint-Venant in plane strain; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "S = λ tr(E) 1 + 2μ E with E_zz = 0",
    build: LawFactory::PlaneStrain { plane: KirchhoffSaintVenant::<3>::boxed, whole: KirchhoffSaintVenant::<4>::boxed },
}

register! { LawEntry "KirchhoffSaintVenantPlaneStress2DLaw",
    about: "Kirchhoff–Saint-Venant in plane stress; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "S = λ tr(E) 1 + 2μ E with S_zz = 0",
    build: LawFactory::PlaneStress(KirchhoffSaintVenant::plane_stress),
}

register! { LawEntry "KirchhoffSaintVenantAxisym2DLaw",
    about: "Kirchhoff–Saint-Venant with axial symmetry; needs YOUNG_MODULUS, POISSON_RATIO",
    source: "S = λ tr(E) 1 + 2μ E on (rr, zz, tt, rz)",
    build: LawFactory::Axisymmetric(KirchhoffSaintVenant::<4>::boxed),
}
