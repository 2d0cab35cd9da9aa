//! Hooke's law of the strain that is not thermal: σ = D(T) (ε − α(T) (T − T₀) 1).
//!
//! The thermal strain is taken off small strains and off Green–Lagrange's alike, as in Kratos. Moduli and expansion follow tables
//! over TEMPERATURE where the properties have them; α is the secant from T₀. Where plane strain has no component across, that
//! direction is held: the others expand by 1 + ν as much.

use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;
use zelus_core::register;

use super::elastic::{Elasticity, multiply, quadratic_energy};
use super::law::{ConstitutiveLaw, LawEntry, LawFactory, Matrix, StrainState};
use super::quantity::Quantity;
use crate::tensor::pairs;

/// The law; `STRESS_FREE` across the plane.
#[derive(Debug, Clone, PartialEq)]
pub struct ThermalElastic<const S: usize, const STRESS_FREE: bool> {
    young: Quantity,
    poisson: f64,
    expansion: Quantity,
    /// T₀.
    reference: f64,
}

impl<const S: usize, const STRESS_FREE: bool> ThermalElastic<S, STRESS_FREE> {
    /// # Errors
    /// Constants that are missing or out of range.
    fn new(properties: &Properties) -> Result<Self> {
        let Elasticity { poisson, .. } = Elasticity::of(properties)?;
        Ok(Self {
            young: Quantity::positive(properties, "YOUNG_MODULUS")?,
            poisson,
            expansion: Quantity::of(properties, "THERMAL_EXPANSION_COEFFICIENT")?,
            reference: properties.require("REFERENCE_TEMPERATURE")?,
        })
    }

    /// Elasticity and the strain without its thermal part.
    fn mechanical(&self, state: &StrainState<'_, S>) -> (Elasticity, [f64; S]) {
        let t = state.temperature;
        let elasticity = Elasticity { young: self.young.at(t), poisson: self.poisson };
        let held = if S == 3 && !STRESS_FREE { 1.0 + self.poisson } else { 1.0 };
        let thermal = held * self.expansion.at(t) * (t - self.reference);
        let mut strain = state.strain;
        for (strain, (p, q)) in strain.iter_mut().zip(pairs::<S>()) {
            *strain -= if p == q { thermal } else { 0.0 };
        }
        (elasticity, strain)
    }
}

/// Hooke's matrix of a form.
trait Form<const S: usize> {
    fn matrix(elasticity: &Elasticity) -> Matrix<S>;
}

impl<const S: usize> Form<S> for ThermalElastic<S, false> {
    fn matrix(elasticity: &Elasticity) -> Matrix<S> {
        elasticity.hooke()
    }
}

impl Form<3> for ThermalElastic<3, true> {
    fn matrix(elasticity: &Elasticity) -> Matrix<3> {
        elasticity.plane_stress()
    }
}

impl<const S: usize, const STRESS_FREE: bool> ConstitutiveLaw<S> for ThermalElastic<S, STRESS_FREE>
where
    Self: Form<S>,
{
    fn pk2(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        let (elasticity, strain) = self.mechanical(state);
        let d = Self::matrix(&elasticity);
        if let Some(tangent) = tangent {
            *tangent = d;
        }
        multiply(&d, &strain)
    }

    fn energy(&self, state: &StrainState<'_, S>) -> f64 {
        let (elasticity, strain) = self.mechanical(state);
        quadratic_energy(&Self::matrix(&elasticity), &strain)
    }

    fn expands(&self) -> bool {
        true
    }

    fn ignores_measure(&self, _small: bool) -> bool {
        true
    }
}

register! { LawEntry "ThermalElasticIsotropic3D",
    about: "Hooke's law that expands; needs THERMAL_EXPANSION_COEFFICIENT, REFERENCE_TEMPERATURE; tables over TEMPERATURE act",
    source: "σ = D (ε − α (T − T₀) 1)",
    build: LawFactory::Space(|properties| Ok(Box::new(ThermalElastic::<6, false>::new(properties)?))),
}

register! { LawEntry "ThermalLinearPlaneStrain",
    about: "Hooke's law of plane strain that expands; constants of ThermalElasticIsotropic3D",
    source: "σ = D (ε − α (T − T₀) 1) with ε_zz = 0",
    build: LawFactory::PlaneStrain {
        plane: |properties| Ok(Box::new(ThermalElastic::<3, false>::new(properties)?)),
        whole: |properties| Ok(Box::new(ThermalElastic::<4, false>::new(properties)?)),
    },
}

register! { LawEntry "ThermalLinearPlaneStress",
    about: "Hooke's law of plane stress that expands; constants of ThermalElasticIsotropic3D",
    source: "σ = D (ε − α (T − T₀) 1) with σ_zz = 0",
    build: LawFactory::PlaneStress(|properties| Ok(Box::new(ThermalElastic::<3, true>::new(properties)?))),
}

register! { LawEntry "ThermalLinearAxisym",
    about: "Hooke's law with axial symmetry that expands; constants of ThermalElasticIsotropic3D",
    source: "σ = D (ε − α (T − T₀) 1) on (rr, zz, tt, rz)",
    build: LawFactory::Axisymmetric(|properties| Ok(Box::new(ThermalElastic::<4, false>::new(properties)?))),
}
