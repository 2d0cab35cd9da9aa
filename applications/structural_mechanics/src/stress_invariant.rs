//! Scalars of a stress that do not depend on axes, σ₁ ≥ σ₂ ≥ σ₃ its principal stresses, positive in tension:
//!
//! von Mises σ_v = √(½ ((σ₁ − σ₂)² + (σ₂ − σ₃)² + (σ₃ − σ₁)²)), Tresca σ₁ − σ₃, pressure p = −(σ₁ + σ₂ + σ₃)/3, positive in compression.

use crate::laws::EquivalentStress;
use crate::tensor::{Tensor, eigen, stress_tensor};

/// A scalar of a stress by which results show it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StressInvariant {
    /// Equivalent stress of von Mises.
    VonMises,
    /// Largest principal stress σ₁.
    MaxPrincipal,
    /// Smallest principal stress σ₃.
    MinPrincipal,
    /// Equivalent stress of Tresca.
    Tresca,
    /// Hydrostatic pressure.
    Pressure,
}

impl StressInvariant {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::VonMises, Self::MaxPrincipal, Self::MinPrincipal, Self::Tresca, Self::Pressure];

    /// The variable that holds it.
    pub fn name(self) -> &'static str {
        match self {
            Self::VonMises => "VON_MISES_STRESS",
            Self::MaxPrincipal => "MAX_PRINCIPAL_STRESS",
            Self::MinPrincipal => "MIN_PRINCIPAL_STRESS",
            Self::Tresca => "TRESCA_STRESS",
            Self::Pressure => "HYDROSTATIC_PRESSURE",
        }
    }

    /// The scalar that a variable holds.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|own| own.name() == name)
    }

    /// Its value.
    pub fn of(self, stress: &Tensor) -> f64 {
        match self {
            Self::VonMises => von_mises(stress),
            Self::MaxPrincipal => principal_stresses(stress)[0],
            Self::MinPrincipal => principal_stresses(stress)[2],
            Self::Tresca => EquivalentStress::Tresca.of(stress).0,
            Self::Pressure => -stress.trace() / 3.0,
        }
    }

    /// Its value for a stress of 3 (plane), 4 (with the stress across the plane) or 6 components; `None` for other numbers.
    pub fn of_vector(self, stress: &[f64]) -> Option<f64> {
        let tensor = match *stress {
            [xx, yy, xy] => stress_tensor(&[xx, yy, xy]),
            [xx, yy, zz, xy] => stress_tensor(&[xx, yy, zz, xy]),
            [xx, yy, zz, xy, yz, xz] => stress_tensor(&[xx, yy, zz, xy, yz, xz]),
            _ => return None,
        };
        Some(self.of(&tensor))
    }
}

/// Principal stresses, largest first; not finite where the stress is not.
pub fn principal_stresses(stress: &Tensor) -> [f64; 3] {
    let mut values: [f64; 3] = eigen(stress).0.into();
    values.sort_by(|a, b| b.total_cmp(a));
    values
}

fn von_mises(t: &Tensor) -> f64 {
    // with s_zz = 0 this is the plane formula sqrt(sx² − sx sy + sy² + 3 txy²)
    let normal = (t[(0, 0)] - t[(1, 1)]).powi(2) + (t[(1, 1)] - t[(2, 2)]).powi(2) + (t[(2, 2)] - t[(0, 0)]).powi(2);
    (0.5 * normal + 3.0 * (t[(0, 1)].powi(2) + t[(1, 2)].powi(2) + t[(0, 2)].powi(2))).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use StressInvariant::{MaxPrincipal, MinPrincipal, Pressure, Tresca, VonMises};

    fn near(value: f64, exact: f64) {
        // Round-off of an eigenvalue, and of sums of a few terms.
        assert!((value - exact).abs() <= 1e-13 * exact.abs().max(1.0), "{value} instead of {exact}");
    }

    /// ANALYTIC: tension, shear, pressure, and a stress whose principal values are the roots 5, 2 and −1.
    #[test]
    fn invariants_are_those_of_known_states() {
        let all = |stress: [f64; 6]| StressInvariant::ALL.map(|own| own.of_vector(&stress).expect("6 components"));
        let check =
            |stress, exact: [f64; 5]| all(stress).into_iter().zip(exact).for_each(|(value, exact)| near(value, exact));
        // in the order of ALL
        check([3.0, 0.0, 0.0, 0.0, 0.0, 0.0], [3.0, 3.0, 0.0, 3.0, -1.0]);
        check([0.0, 0.0, 0.0, 2.0, 0.0, 0.0], [2.0 * 3.0_f64.sqrt(), 2.0, -2.0, 4.0, 0.0]);
        check([-7.0, -7.0, -7.0, 0.0, 0.0, 0.0], [0.0, -7.0, -7.0, 0.0, 7.0]);
        check([2.0, 2.0, 2.0, 0.0, 3.0, 0.0], [27.0_f64.sqrt(), 5.0, -1.0, 6.0, -2.0]);
    }

    #[test]
    fn vectors_of_the_plane_have_their_own_components() {
        near(MaxPrincipal.of_vector(&[1.0, 1.0, 2.0]).expect("plane"), 3.0);
        near(MinPrincipal.of_vector(&[1.0, 1.0, 2.0]).expect("plane"), -1.0);
        near(Tresca.of_vector(&[1.0, 1.0, -5.0, 0.0]).expect("about an axis"), 6.0);
        near(Pressure.of_vector(&[1.0, 1.0, -5.0, 0.0]).expect("about an axis"), 1.0);
        assert_eq!(VonMises.of_vector(&[1.0, 2.0]), None);
    }
}
