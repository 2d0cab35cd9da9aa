//! Laws of friction: how large the tangential traction of a node in contact may become.
//!
//! - Coulomb: |t| ≤ −μ p, with the normal pressure p < 0 in compression;
//! - Tresca: |t| ≤ τ, whatever the pressure.

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::Diagnostic;
use zelus_core::model::{Nodes, Variable};
use zelus_core::registry;
use zelus_core::scalar::Real;
use zelus_core::{register, registered_kind};

use crate::variables::{FRICTION_COEFFICIENT, TRESCA_FRICTION_THRESHOLD};

/// Coefficients below this count as none.
const NOTHING: f64 = f64::EPSILON;

/// Limit c − μ p of a node's tangential traction (force per area).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Bound {
    /// μ ≥ 0: the part that grows with the pressure.
    pub coefficient: f64,
    /// c ≥ 0: the part that does not (force per area).
    pub threshold: f64,
}

impl Bound {
    /// The limit under a normal pressure, which is negative in compression.
    #[inline]
    pub fn at<T: Real>(self, pressure: T) -> T {
        pressure * -self.coefficient + self.threshold
    }

    /// Whether there is no friction at all.
    pub fn is_smooth(self) -> bool {
        self.coefficient < NOTHING && self.threshold <= 0.0
    }
}

registered_kind! {
    /// A friction law, by the name of `frictional_law`.
    pub struct FrictionLawEntry("friction_law", "unknown-name") {
        build: FrictionLaw;
    }
}

/// A law of friction.
pub struct FrictionLaw {
    /// The number that the law needs at a node, read from properties or nodes under this name.
    pub variable: &'static Variable<f64>,
    /// The bound for that number.
    pub bound: fn(f64) -> Bound,
    /// Whether `friction_coefficients` of the process stands in where properties say nothing.
    pub by_coefficients: bool,
}

impl FrictionLaw {
    /// The bound at a node whose number is written.
    pub fn bound_at(&self, nodes: &Nodes, at: usize) -> Bound {
        (self.bound)(nodes.values.values(self.variable, 0).get(at).copied().unwrap_or(0.0))
    }
}

impl std::fmt::Debug for FrictionLaw {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "friction law by {}", self.variable.name())
    }
}

impl PartialEq for FrictionLaw {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}

/// The law that acts without a name.
pub const COULOMB: FrictionLaw = FrictionLaw {
    variable: &FRICTION_COEFFICIENT,
    bound: |coefficient| Bound { coefficient, threshold: 0.0 },
    by_coefficients: true,
};

const TRESCA: FrictionLaw = FrictionLaw {
    variable: &TRESCA_FRICTION_THRESHOLD,
    bound: |threshold| Bound { coefficient: 0.0, threshold },
    by_coefficients: false,
};

/// The law of a `frictional_law`.
///
/// # Errors
/// A name that no law has.
pub fn find_friction_law(name: &str) -> Result<&'static FrictionLaw, Diagnostic> {
    registry::require::<FrictionLawEntry>(name).map(|entry| &entry.build)
}

register! { FrictionLawEntry "Coulomb",
    about: "limit of the tangential traction: FRICTION_COEFFICIENT times the pressure",
    source: "|t| ≤ −μ p; Coulomb (1785)",
    build: COULOMB,
}
register! { FrictionLawEntry "Tresca",
    about: "limit of the tangential traction: TRESCA_FRICTION_THRESHOLD, whatever the pressure",
    source: "|t| ≤ τ_max; Tresca (1864)",
    build: TRESCA,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds() {
        assert_eq!((COULOMB.bound)(0.3).at(-10.0), 3.0);
        assert_eq!((TRESCA.bound)(0.3).at(-10.0), 0.3);
        assert!((COULOMB.bound)(0.0).is_smooth() && (TRESCA.bound)(0.0).is_smooth());
        assert!(!(TRESCA.bound)(1e-3).is_smooth());
    }

    #[test]
    fn unknown_laws_are_refused_with_a_suggestion() {
        let Err(error) = find_friction_law("Coulom") else { panic!("there is no such law") };
        let error = error.to_string();
        assert!(error.contains("Coulom") && error.contains("\"Coulomb\""), "{error}");
        assert!(find_friction_law("Tresca").is_ok());
    }
}
