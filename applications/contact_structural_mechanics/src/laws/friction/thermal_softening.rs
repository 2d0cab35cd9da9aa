//! Friction that falls with the temperature: μ(T) = μ₀ (1 − θ^q), θ = (T − T_r)/(T_m − T_r) from 0 to 1.
//!
//! T is the temperature of contact. With q = 1 the coefficient falls linearly from μ₀ at T_r to nothing at T_m.

use zelus_core::register;

use super::COULOMB;
use crate::law::{Bound, FrictionLaw, FrictionLawEntry};
use crate::variables::{FRICTION_MELTING_TEMPERATURE, FRICTION_REFERENCE_TEMPERATURE, FRICTION_SOFTENING_EXPONENT};

register! { FrictionLawEntry "ThermalSoftening",
    about: "FRICTION_COEFFICIENT up to FRICTION_REFERENCE_TEMPERATURE, which falls by FRICTION_SOFTENING_EXPONENT to 0 at FRICTION_MELTING_TEMPERATURE",
    source: "|t| ≤ −μ p, μ = μ₀ (1 − ((T − T_r)/(T_m − T_r))^q); Moufki, Molinari and Dudzinski (1998), who count T from 0",
    build: FrictionLaw {
        constants: &[&FRICTION_SOFTENING_EXPONENT],
        temperatures: &[&FRICTION_REFERENCE_TEMPERATURE, &FRICTION_MELTING_TEMPERATURE],
        check: |numbers| {
            let (exponent, reference, melting) = (numbers[1], numbers[2], numbers[3]);
            if exponent <= 0.0 {
                return Err("FRICTION_SOFTENING_EXPONENT must be positive");
            }
            if melting <= reference {
                return Err("FRICTION_MELTING_TEMPERATURE must be above FRICTION_REFERENCE_TEMPERATURE");
            }
            Ok(())
        },
        bound: |numbers, sliding| {
            let (coefficient, exponent, reference, melting) = (numbers[0], numbers[1], numbers[2], numbers[3]);
            let softened = ((sliding.temperature - reference) / (melting - reference)).clamp(0.0, 1.0);
            Bound { coefficient: coefficient * (1.0 - softened.powf(exponent)), threshold: 0.0 }
        },
        depends_on_sliding: true,
        ..COULOMB
    },
}
