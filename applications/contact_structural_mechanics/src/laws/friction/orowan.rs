//! Orowan: Coulomb's friction up to a shear stress that the softer body bears, |t| ≤ min(−μ p, τ).

use zelus_core::register;

use super::COULOMB;
use crate::law::{Bound, FrictionLaw, FrictionLawEntry};
use crate::variables::{FRICTION_COEFFICIENT, TRESCA_FRICTION_THRESHOLD};

register! { FrictionLawEntry "Orowan",
    about: "Coulomb's limit, at most TRESCA_FRICTION_THRESHOLD",
    source: "|t| ≤ min(−μ p, τ_max); Orowan (1943)",
    build: FrictionLaw {
        strengths: &[&FRICTION_COEFFICIENT, &TRESCA_FRICTION_THRESHOLD],
        constants: &[],
        bound: |numbers, sliding| {
            let (coefficient, threshold) = (numbers[0], numbers[1]);
            if -coefficient * sliding.pressure < threshold {
                Bound { coefficient, threshold: 0.0 }
            } else {
                Bound { coefficient: 0.0, threshold }
            }
        },
        depends_on_sliding: true,
        ..COULOMB
    },
}
