//! Constitutive laws: stress and tangent from strain and the history of the point.
//!
//! A law has the number of its Voigt components in its type (3 plane, 4 axisymmetric, 6 solid), so an element can only hold one that
//! fits. The history of a law lies with the element, which passes it in and lets it advance once a step is accepted.

mod arruda_boyce;
mod bar_law;
mod blatz_ko;
mod constants;
mod damage;
#[cfg(test)]
mod damage_tests;
mod elastic;
mod equivalent_stress;
mod expanding;
mod expansion;
#[cfg(test)]
mod expanding_tests;
mod finite_strain_plasticity;
mod fit;
#[cfg(test)]
mod fit_tests;
mod gent;
mod hardening;
mod hooke;
mod hyper_elastic;
mod isochoric_neo_hooke;
mod j2;
mod kirchhoff_saint_venant;
mod kinematic_hardening;
mod kinematic_plasticity;
#[cfg(test)]
mod kinematic_tests;
mod law;
mod linear_elastic;
mod linear_elastic_orthotropic;
mod material_axes;
mod orthotropic_elasticity;
#[cfg(test)]
mod orthotropic_tests;
#[cfg(test)]
mod creep_tests;
mod mooney_rivlin;
mod mullins;
mod norton_creep;
mod ogden;
mod parallel_mixture;
mod prony;
mod quantity;
mod rubber;
#[cfg(test)]
mod rubber_tests;
mod stability;
mod strain_energy;
mod stretch_energy;
#[cfg(test)]
mod plasticity_tests;
mod small_strain_plasticity;
mod small_strain_viscoelasticity;
mod thermal_elastic;
mod uniaxial;
mod yeoh;
#[cfg(test)]
mod tests;

pub use arruda_boyce::ArrudaBoyce;
pub use bar_law::{BarLaw, MakeBarLaw};
pub use blatz_ko::BlatzKo;
pub use damage::IsotropicDamage;
pub use elastic::Elasticity;
pub use equivalent_stress::EquivalentStress;
pub use finite_strain_plasticity::FiniteStrainPlasticity;
pub use fit::{Constants, Fit, FitStart, TestData, energy_with, fit, stable_stretches};
pub use gent::Gent;
pub use hardening::Hardening;
pub use hooke::Hooke;
pub use hyper_elastic::HyperElastic;
pub use isochoric_neo_hooke::IsochoricNeoHooke;
pub use j2::J2;
pub use kinematic_hardening::{KinematicHardening, KinematicReturn};
pub use kinematic_plasticity::KinematicPlasticity;
pub use kirchhoff_saint_venant::KirchhoffSaintVenant;
pub use law::{
    ConstitutiveLaw, LawEntry, LawFactory, MakeLaw, MakesLaw, Matrix, StrainState, StressMeasure, has_axes, law_of,
};
pub use linear_elastic::LinearElastic;
pub use linear_elastic_orthotropic::LinearElasticOrthotropic;
pub(crate) use material_axes::of_element as axes_of_element;
pub use mooney_rivlin::MooneyRivlin;
pub use norton_creep::NortonCreep;
pub use ogden::Ogden;
pub use orthotropic_elasticity::{OrthotropicElasticity, representative_young};
pub use parallel_mixture::ParallelMixture;
pub use rubber::{Energy, EnergyKind, Rubber};
pub use small_strain_plasticity::{PLASTIC_WORK, SmallStrainPlasticity};
pub use small_strain_viscoelasticity::SmallStrainViscoelasticity;
pub use stability::{BiaxialResponse, HomogeneousTest, first_instability};
pub use strain_energy::{ElasticResponse, EnergyDerivatives, InvariantEnergy, RightCauchyGreen};
pub use stretch_energy::StretchEnergy;
pub use thermal_elastic::ThermalElastic;
pub(crate) use uniaxial::positive;
pub use yeoh::Yeoh;
