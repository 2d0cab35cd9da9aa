//! Orthotropic elasticity along the axes of the material: σ = Aᵀ D(A ε) with the axes A of [`super::material_axes`].
//!
//! In elements of finite deformation it lies between Green–Lagrange strain and second Piola–Kirchhoff stress, as
//! Kirchhoff–Saint-Venant's law does: the axes turn with the body.

use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;
use zelus_core::register;

use super::elastic::{multiply, quadratic_energy};
use super::law::{ConstitutiveLaw, LawEntry, LawFactory, Matrix, StrainState};
use super::material_axes;
use super::orthotropic_elasticity::{
    CONSTANTS, CONSTANTS_ABOUT_AN_AXIS, CONSTANTS_OF_PLANE_STRESS, CONSTANTS_OF_SECTIONS, OrthotropicElasticity,
};
use crate::tensor::{congruent, inverse, push_forward, strain_tensor, strain_vector};

/// Linear law with a constant matrix in the axes of the element.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearElasticOrthotropic<const S: usize> {
    /// The matrix D, turned by the EULER_ANGLES of the material.
    d: Matrix<S>,
}

impl<const S: usize> LinearElasticOrthotropic<S> {
    /// # Errors
    /// EULER_ANGLES that are out of range.
    fn boxed(properties: &Properties, elasticity: OrthotropicElasticity) -> Result<Box<dyn ConstitutiveLaw<S>>> {
        let axes = material_axes::of_properties(properties, S < 6)?;
        Ok(Box::new(Self { d: push_forward(&elasticity.matrix::<S>(), &axes.transpose(), 1.0) }))
    }

    fn orthotropic(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<S>>> {
        Self::boxed(properties, OrthotropicElasticity::of(properties, S == 6)?)
    }

    fn transversely_isotropic(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<S>>> {
        Self::boxed(properties, OrthotropicElasticity::about_an_axis(properties)?)
    }

    /// D in the axes of the space.
    fn matrix(&self, state: &StrainState<'_, S>) -> Matrix<S> {
        state.axes.map_or(self.d, |axes| push_forward(&self.d, &axes.transpose(), 1.0))
    }
}

impl<const S: usize> ConstitutiveLaw<S> for LinearElasticOrthotropic<S> {
    fn pk2(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        let d = self.matrix(state);
        if let Some(tangent) = tangent {
            *tangent = d;
        }
        multiply(&d, &state.strain)
    }

    fn energy(&self, state: &StrainState<'_, S>) -> f64 {
        quadratic_energy(&self.matrix(state), &state.strain)
    }

    fn has_axes(&self) -> bool {
        true
    }

    fn ignores_measure(&self, small: bool) -> bool {
        small
    }

    /// e = F⁻ᵀ E F⁻¹ in elements of finite deformation.
    fn almansi(&self, state: &StrainState<'_, S>) -> [f64; S] {
        if state.small {
            return state.strain;
        }
        strain_vector(&congruent(&inverse(&state.f).transpose(), &strain_tensor(&state.strain)))
    }
}

register! { LawEntry "LinearElasticOrthotropic3DLaw",
    about: "Orthotropic elasticity for solids; needs YOUNG_MODULUS_X, _Y, _Z, POISSON_RATIO_XY, _YZ, _XZ, SHEAR_MODULUS_XY, _YZ, _XZ; takes EULER_ANGLES, and LOCAL_AXIS_1 and LOCAL_AXIS_2 of elements",
    source: "S_ii = 1/E_i, S_ij = −ν_ij/E_i, γ_ij = τ_ij/G_ij along the axes of the material",
    takes: CONSTANTS,
    has_axes: true,
    build: LawFactory::Space(LinearElasticOrthotropic::<6>::orthotropic),
}

register! { LawEntry "LinearElasticOrthotropic2DLaw",
    about: "Orthotropic elasticity in plane stress; needs YOUNG_MODULUS_X, YOUNG_MODULUS_Y, POISSON_RATIO_XY, SHEAR_MODULUS_XY; takes EULER_ANGLES, and LOCAL_AXIS_1 of elements",
    source: "S_ii = 1/E_i, S_xy = −ν_xy/E_x, γ_xy = τ_xy/G_xy with σ_zz = 0",
    takes: CONSTANTS_OF_PLANE_STRESS,
    has_axes: true,
    build: LawFactory::PlaneStress(|properties| {
        LinearElasticOrthotropic::<3>::boxed(properties, OrthotropicElasticity::of_plane_stress(properties)?)
    }),
}

register! { LawEntry "LinearElasticOrthotropicPlaneStrain2DLaw",
    about: "Orthotropic elasticity in plane strain; needs YOUNG_MODULUS_X, _Y, _Z, POISSON_RATIO_XY, _YZ, _XZ, SHEAR_MODULUS_XY; takes EULER_ANGLES, and LOCAL_AXIS_1 of elements",
    source: "S_ii = 1/E_i, S_ij = −ν_ij/E_i, γ_xy = τ_xy/G_xy with ε_zz = 0",
    takes: CONSTANTS_OF_SECTIONS,
    has_axes: true,
    build: LawFactory::PlaneStrain {
        plane: LinearElasticOrthotropic::<3>::orthotropic,
        whole: LinearElasticOrthotropic::<4>::orthotropic,
    },
}

register! { LawEntry "LinearElasticOrthotropicAxisym2DLaw",
    about: "Orthotropic elasticity with axial symmetry, Z the hoop direction; constants of LinearElasticOrthotropicPlaneStrain2DLaw",
    source: "S_ii = 1/E_i, S_ij = −ν_ij/E_i, γ_xy = τ_xy/G_xy on (rr, zz, tt, rz)",
    takes: CONSTANTS_OF_SECTIONS,
    has_axes: true,
    build: LawFactory::Axisymmetric(LinearElasticOrthotropic::<4>::orthotropic),
}

register! { LawEntry "LinearElasticTransverselyIsotropic3DLaw",
    about: "Elasticity that is isotropic across the axis X, for solids; needs YOUNG_MODULUS_X, YOUNG_MODULUS_Y, POISSON_RATIO_XY, POISSON_RATIO_YZ, SHEAR_MODULUS_XY; takes axes as LinearElasticOrthotropic3DLaw",
    source: "E_z = E_y, ν_xz = ν_xy, G_xz = G_xy, G_yz = E_y/(2 (1 + ν_yz))",
    takes: CONSTANTS_ABOUT_AN_AXIS,
    has_axes: true,
    build: LawFactory::Space(LinearElasticOrthotropic::<6>::transversely_isotropic),
}

register! { LawEntry "LinearElasticTransverselyIsotropicPlaneStrain2DLaw",
    about: "Elasticity that is isotropic across the axis X, in plane strain; constants of LinearElasticTransverselyIsotropic3DLaw",
    source: "E_z = E_y, ν_xz = ν_xy with ε_zz = 0",
    takes: CONSTANTS_ABOUT_AN_AXIS,
    has_axes: true,
    build: LawFactory::PlaneStrain {
        plane: LinearElasticOrthotropic::<3>::transversely_isotropic,
        whole: LinearElasticOrthotropic::<4>::transversely_isotropic,
    },
}

register! { LawEntry "LinearElasticTransverselyIsotropicAxisym2DLaw",
    about: "Elasticity that is isotropic across the axis X, with axial symmetry; constants of LinearElasticTransverselyIsotropic3DLaw",
    source: "E_z = E_y, ν_xz = ν_xy on (rr, zz, tt, rz)",
    takes: CONSTANTS_ABOUT_AN_AXIS,
    has_axes: true,
    build: LawFactory::Axisymmetric(LinearElasticOrthotropic::<4>::transversely_isotropic),
}
