//! Constitutive laws: stress and tangent from strain.
//!
//! A law has the number of its Voigt components in its type (3 plane, 4 axisymmetric, 6 solid), so an element can only
//! hold one that fits. Laws of this crate have no history.

mod elastic;
mod hyper_elastic;
mod kirchhoff_saint_venant;
mod law;
mod linear_elastic;
#[cfg(test)]
mod tests;

pub use elastic::Elasticity;
pub use hyper_elastic::HyperElastic;
pub use kirchhoff_saint_venant::KirchhoffSaintVenant;
pub use law::{ConstitutiveLaw, LawFactory, Matrix, StrainState, StressMeasure, law_of};
pub use linear_elastic::LinearElastic;
