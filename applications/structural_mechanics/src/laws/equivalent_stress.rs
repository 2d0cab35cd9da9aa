//! Equivalent stresses: the measure of a stress that is compared with the uniaxial strength.

use crate::tensor::{Tensor, deviator, eigen};

/// How a stress is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EquivalentStress {
    /// √(3/2) ‖dev σ‖.
    VonMises,
    /// The largest principal stress, where it pulls: for materials that crack.
    Rankine,
    /// The largest less the smallest principal stress.
    Tresca,
}

impl EquivalentStress {
    /// The equivalent stress and its derivative with respect to the tensor; where principal stresses are equal, that of one side.
    pub(crate) fn of(self, stress: &Tensor) -> (f64, Tensor) {
        if self == Self::VonMises {
            let s = deviator(stress);
            let q = 1.5_f64.sqrt() * s.norm();
            return (q, if q > 0.0 { 1.5 / q * s } else { Tensor::zeros() });
        }
        let (values, vectors) = eigen(stress);
        let by = |at: usize| {
            let n = vectors.column(at);
            n * n.transpose()
        };
        let (most, least) = (values.imax(), values.imin());
        match self {
            Self::Rankine if values[most] <= 0.0 => (0.0, Tensor::zeros()),
            Self::Rankine => (values[most], by(most)),
            _ => (values[most] - values[least], by(most) - by(least)),
        }
    }
}
