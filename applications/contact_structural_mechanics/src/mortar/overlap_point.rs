//! A point of the overlap of a pair.

use zelus_core::geometry::Nodal;
use zelus_core::scalar::Real;

/// A point of the slave that faces a point of the master.
#[derive(Debug, Clone, Copy)]
pub struct OverlapPoint<T: Real> {
    /// Local coordinates on the slave.
    pub local: [T; 2],
    /// Shape functions of the slave.
    pub slave: Nodal<T>,
    /// Shape functions of the master.
    pub master: Nodal<T>,
    /// Length or area that it stands for; about an axis also 2π r by the thickness.
    pub weight: T,
}

impl<T: Real> OverlapPoint<T> {
    /// Room for points, which with derivatives are too large to be moved about.
    pub(super) fn room() -> Self {
        Self { local: [T::zero(); 2], slave: Nodal::empty(), master: Nodal::empty(), weight: T::zero() }
    }
}
