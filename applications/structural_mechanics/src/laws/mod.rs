//! Constitutive laws: stress and tangent from strain and the history of the point.
//!
//! A law has the number of its Voigt components in its type (3 plane, 4 axisymmetric, 6 solid), so an element can only hold one that
//! fits. The history of a law lies with the element, which passes it in and lets it advance once a step is accepted.

mod bar_law;
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
mod norton_creep;
mod parallel_mixture;
mod quantity;
#[cfg(test)]
mod plasticity_tests;
mod small_strain_plasticity;
mod thermal_elastic;
mod uniaxial;
#[cfg(test)]
mod tests;

pub use bar_law::{BarLaw, MakeBarLaw};
pub use damage::IsotropicDamage;
pub use elastic::Elasticity;
pub use equivalent_stress::EquivalentStress;
pub use finite_strain_plasticity::FiniteStrainPlasticity;
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
pub use norton_creep::NortonCreep;
pub use orthotropic_elasticity::{OrthotropicElasticity, representative_young};
pub use parallel_mixture::ParallelMixture;
pub use small_strain_plasticity::{PLASTIC_WORK, SmallStrainPlasticity};
pub use thermal_elastic::ThermalElastic;
pub(crate) use uniaxial::positive;
