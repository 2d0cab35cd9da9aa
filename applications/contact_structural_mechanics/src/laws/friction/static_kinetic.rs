//! Static and kinetic friction: μ(v) = μ_k + (μ_s − μ_k) exp(−α v) with the sliding speed v.

use zelus_core::register;

use super::COULOMB;
use crate::law::{Bound, FrictionLaw, FrictionLawEntry};
use crate::variables::{FRICTION_COEFFICIENT, FRICTION_DECAY, KINETIC_FRICTION_COEFFICIENT};

register! { FrictionLawEntry "StaticKinetic",
    about: "FRICTION_COEFFICIENT at rest, which tends to KINETIC_FRICTION_COEFFICIENT with the sliding speed, by FRICTION_DECAY",
    source: "|t| ≤ −μ p, μ = μ_k + (μ_s − μ_k) exp(−α v); Oden and Martins (1985)",
    build: FrictionLaw {
        strengths: &[&FRICTION_COEFFICIENT, &KINETIC_FRICTION_COEFFICIENT],
        constants: &[&FRICTION_DECAY],
        bound: |numbers, sliding| {
            let (at_rest, kinetic, decay) = (numbers[0], numbers[1], numbers[2]);
            Bound { coefficient: kinetic + (at_rest - kinetic) * (-decay * sliding.speed).exp(), threshold: 0.0 }
        },
        depends_on_sliding: true,
        ..COULOMB
    },
}
