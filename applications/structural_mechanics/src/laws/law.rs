//! What a constitutive law is, and how an element gets the one its properties name.

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::Properties;
use zelus_core::registry::{Build, Kind, require};

use crate::tensor::{Tensor, congruent, push_forward, stress_tensor, stress_vector};

/// A Voigt matrix `m[row][column]`.
pub type Matrix<const S: usize> = [[f64; S]; S];

/// Deformation of a material point as the element describes it.
#[derive(Debug, Clone, Copy)]
pub struct StrainState<const S: usize> {
    /// Green–Lagrange strain, or the small strain of a small-displacement element (shear doubled).
    pub strain: [f64; S],
    /// Deformation gradient; 1 + strain in a small-displacement element.
    pub f: Tensor,
    /// Determinant of `f`, positive.
    pub det_f: f64,
    /// Whether `strain` is the small strain and `f` is 1 + strain.
    pub small: bool,
}

/// Which stress an element integrates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StressMeasure {
    /// Second Piola–Kirchhoff stress, on the initial configuration.
    Pk2,
    /// Cauchy stress, on the present configuration.
    Cauchy,
}

/// Stress, tangent and energy of a material point with `S` Voigt components.
pub trait ConstitutiveLaw<const S: usize>: Send + Sync {
    /// Second Piola–Kirchhoff stress; its derivative with respect to the strain too, when asked.
    fn pk2(&self, state: &StrainState<S>, tangent: Option<&mut Matrix<S>>) -> [f64; S];

    /// Stored energy per initial volume.
    fn energy(&self, state: &StrainState<S>) -> f64;

    /// Whether the stress is a constant matrix times the strain.
    fn is_linear(&self) -> bool {
        false
    }

    /// Whether the same numbers serve as every stress measure, as if deformations were small.
    fn ignores_measure(&self) -> bool {
        false
    }

    /// Strain to report as Almansi's; the Green–Lagrange strain unless the law distinguishes them.
    fn almansi(&self, state: &StrainState<S>) -> [f64; S] {
        state.strain
    }

    /// Stress in the wanted measure with its tangent: dS/dE, or its push-forward for Cauchy stress.
    fn stress(&self, state: &StrainState<S>, measure: StressMeasure, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        if measure == StressMeasure::Pk2 || self.ignores_measure() {
            return self.pk2(state, tangent);
        }
        let pk2 = match tangent {
            None => self.pk2(state, None),
            Some(tangent) => {
                let pk2 = self.pk2(state, Some(tangent));
                *tangent = push_forward(tangent, &state.f, state.det_f);
                pk2
            }
        };
        stress_vector(&congruent(&state.f, &stress_tensor(&pk2))).map(|s| s / state.det_f)
    }
}

/// Makes a law with `S` Voigt components from the properties; what a registration holds.
pub struct LawFactory<const S: usize>(pub fn(&Properties) -> Result<Box<dyn ConstitutiveLaw<S>>>);

/// The law that the properties name, for an element with `S` Voigt components.
///
/// # Errors
/// No law, an unknown one, one of another dimension, or missing material constants.
pub fn law_of<const S: usize>(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<S>>> {
    let place = properties.place.clone();
    let Some(name) = &properties.law else {
        let fact = format!("properties {} are used by solid elements but have no constitutive law", properties.id);
        let remedy = "give a \"constitutive_law\" in the materials file, or CONSTITUTIVE_LAW in the mesh file";
        return Err(Diagnostic::error("missing-law", fact).at(place).remedy(remedy).into());
    };
    let entry = require(Kind::ConstitutiveLaw, name).map_err(|problem| problem.at(place.clone()))?;
    match &entry.build {
        Build::Factory(factory) if let Some(LawFactory(make)) = factory.downcast_ref::<LawFactory<S>>() => {
            make(properties)
        }
        _ => {
            let kind = match S {
                3 => "planar",
                4 => "axisymmetric",
                _ => "three-dimensional",
            };
            let fact = format!("the law {} of properties {} does not fit {kind} elements", entry.name, properties.id);
            let remedy = format!("use a law for {kind} elements ({S} strain components)");
            Err(Diagnostic::error("law-does-not-fit", fact).at(place).remedy(remedy).into())
        }
    }
}
