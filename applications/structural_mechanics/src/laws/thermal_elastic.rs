//! Hooke's law of the strain that is not thermal: σ = D(T) (ε − α(T) (T − T₀) 1).
//!
//! The thermal strain is taken off small strains and off Green–Lagrange's alike, as in Kratos. Moduli and expansion follow tables
//! over TEMPERATURE where the properties have them; α is the secant from T₀. Where plane strain has no component across, that
//! direction is held: the others expand by 1 + ν as much.

use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;
use zelus_core::register;

use super::elastic::{Elasticity, multiply, quadratic_energy};
use super::expansion::{self, Expansion, in_form, without};
use super::law::{ConstitutiveLaw, LawEntry, LawFactory, Matrix, StrainState};
use super::quantity::Quantity;

/// The law; `STRESS_FREE` across the plane.
#[derive(Debug, Clone, PartialEq)]
pub struct ThermalElastic<const S: usize, const STRESS_FREE: bool> {
    young: Quantity,
    poisson: f64,
    expansion: Expansion,
}

impl<const S: usize, const STRESS_FREE: bool> ThermalElastic<S, STRESS_FREE> {
    /// # Errors
    /// Constants that are missing or out of range.
    fn new(properties: &Properties) -> Result<Self> {
        let Elasticity { poisson, .. } = Elasticity::of(properties)?;
        Ok(Self {
            young: Quantity::positive(properties, "YOUNG_MODULUS")?,
            poisson,
            expansion: Expansion::of(properties)?,
        })
    }

    /// Hooke's matrix, and the strain without its thermal part.
    fn mechanical(&self, state: &StrainState<'_, S>) -> (Matrix<S>, [f64; S]) {
        let t = state.temperature;
        let elasticity = Elasticity { young: self.young.at(t), poisson: self.poisson };
        let thermal = in_form::<S>(self.expansion.strain(t), self.poisson, STRESS_FREE);
        (elasticity.in_form(STRESS_FREE), without(state.strain, thermal))
    }
}

impl<const S: usize, const STRESS_FREE: bool> ConstitutiveLaw<S> for ThermalElastic<S, STRESS_FREE> {
    fn pk2(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        let (d, strain) = self.mechanical(state);
        if let Some(tangent) = tangent {
            *tangent = d;
        }
        multiply(&d, &strain)
    }

    fn energy(&self, state: &StrainState<'_, S>) -> f64 {
        let (d, strain) = self.mechanical(state);
        quadratic_energy(&d, &strain)
    }

    fn expands(&self) -> bool {
        true
    }

    fn ignores_measure(&self, _small: bool) -> bool {
        true
    }
}

register! { LawEntry "ThermalElasticIsotropic3D",
    about: "Hooke's law with thermal expansion; needs THERMAL_EXPANSION_COEFFICIENT, REFERENCE_TEMPERATURE; reads tables over TEMPERATURE",
    source: "σ = D (ε − α (T − T₀) 1)",
    takes: expansion::CONSTANTS,
    build: LawFactory::Space(|properties| Ok(Box::new(ThermalElastic::<6, false>::new(properties)?))),
}

register! { LawEntry "ThermalLinearPlaneStrain",
    about: "Hooke's law of plane strain with thermal expansion; constants of ThermalElasticIsotropic3D",
    source: "σ = D (ε − α (T − T₀) 1) with ε_zz = 0",
    takes: expansion::CONSTANTS,
    build: LawFactory::PlaneStrain {
        plane: |properties| Ok(Box::new(ThermalElastic::<3, false>::new(properties)?)),
        whole: |properties| Ok(Box::new(ThermalElastic::<4, false>::new(properties)?)),
    },
}

register! { LawEntry "ThermalLinearPlaneStress",
    about: "Hooke's law of plane stress with thermal expansion; constants of ThermalElasticIsotropic3D",
    source: "σ = D (ε − α (T − T₀) 1) with σ_zz = 0",
    takes: expansion::CONSTANTS,
    build: LawFactory::PlaneStress(|properties| Ok(Box::new(ThermalElastic::<3, true>::new(properties)?))),
}

register! { LawEntry "ThermalLinearAxisym",
    about: "Hooke's law with axial symmetry and thermal expansion; constants of ThermalElasticIsotropic3D",
    source: "σ = D (ε − α (T − T₀) 1) on (rr, zz, tt, rz)",
    takes: expansion::CONSTANTS,
    build: LawFactory::Axisymmetric(|properties| Ok(Box::new(ThermalElastic::<4, false>::new(properties)?))),
}
