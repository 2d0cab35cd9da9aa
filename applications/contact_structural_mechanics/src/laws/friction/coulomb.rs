//! Coulomb: |t| ≤ −μ p, with the normal pressure p < 0 in compression.

use zelus_core::register;

use crate::law::{Bound, FrictionLaw, FrictionLawEntry};
use crate::variables::FRICTION_COEFFICIENT;

/// The law that acts without a name.
pub const COULOMB: FrictionLaw = FrictionLaw {
    strengths: &[&FRICTION_COEFFICIENT],
    constants: &[],
    temperatures: &[],
    check: |_| Ok(()),
    bound: |numbers, _| Bound { coefficient: numbers[0], threshold: 0.0 },
    depends_on_sliding: false,
    by_coefficients: true,
};

register! { FrictionLawEntry "Coulomb",
    about: "limit of the tangential traction: FRICTION_COEFFICIENT times the pressure",
    source: "|t| ≤ −μ p; Coulomb (1785)",
    build: COULOMB,
}
