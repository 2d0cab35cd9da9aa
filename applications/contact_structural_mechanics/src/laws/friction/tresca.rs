//! Tresca: |t| ≤ τ, whatever the pressure.

use zelus_core::register;

use super::COULOMB;
use crate::law::{Bound, FrictionLaw, FrictionLawEntry};
use crate::variables::TRESCA_FRICTION_THRESHOLD;

register! { FrictionLawEntry "Tresca",
    about: "limit of the tangential traction: TRESCA_FRICTION_THRESHOLD, whatever the pressure",
    source: "|t| ≤ τ_max; Tresca (1864)",
    build: FrictionLaw {
        strengths: &[&TRESCA_FRICTION_THRESHOLD],
        bound: |numbers, _| Bound { coefficient: 0.0, threshold: numbers[0] },
        by_coefficients: false,
        ..COULOMB
    },
}
