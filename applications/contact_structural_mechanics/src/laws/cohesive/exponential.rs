//! Exponential: traction that falls as exp(−(x − 1)/c) with the opening, x = 1 at the onset of damage.
//!
//! d = 1 − exp(−(x − 1)/c)/x, c = (r − 1)/2, r = G/e₀. Dissipated: e₀ [1 + 2 c (1 − exp(−(x − 1)/c)) − (1 − d) x²].

use zelus_core::register;
use zelus_core::scalar::Real;

use super::mixed_mode::{ByMode, MixedMode};
use crate::law::{CohesiveLaw, CohesiveLawEntry};
use crate::mortar::Active;

/// Iterations that find an opening: each halves an interval.
const ITERATIONS: usize = 200;

struct Exponential(MixedMode);

/// Share 1 − d of the bond that is sound at an opening beyond 1.
fn sound<T: Real>(opening: T, ratio: T) -> T {
    let width = (ratio - 1.0) * 0.5;
    (-(opening - 1.0) / width).exp() / opening
}

/// Opening at which the bond has a damage below 1.
fn opening(damage: f64, ratio: f64) -> f64 {
    let mut range = [1.0, 2.0];
    while 1.0 - sound(range[1], ratio) < damage {
        range = [range[1], 2.0 * range[1]];
    }
    for _ in 0..ITERATIONS {
        let middle = 0.5 * (range[0] + range[1]);
        let side = usize::from(1.0 - sound(middle, ratio) >= damage);
        if middle == range[0] || middle == range[1] {
            break;
        }
        range[side] = middle;
    }
    range[1]
}

impl CohesiveLaw for Exponential {
    fn stiffness(&self) -> [f64; 2] {
        self.0.stiffness
    }

    fn damage(&self, energies: [Active; 2]) -> Active {
        match self.0.at(energies) {
            Some(ByMode { ratio, opening, .. }) if opening.value() > 1.0 => -sound(opening, ratio) + 1.0,
            _ => Active::zero(),
        }
    }

    fn dissipated(&self, energies: [f64; 2], damage: f64) -> f64 {
        let Some(ByMode { onset, ratio, .. }) = self.0.at(energies).filter(|_| damage > 0.0) else { return 0.0 };
        if damage >= 1.0 {
            return onset * ratio;
        }
        let opening = opening(damage, ratio);
        let fallen = -(-2.0 * (opening - 1.0) / (ratio - 1.0)).exp_m1();
        onset * (1.0 + (ratio - 1.0) * fallen - sound(opening, ratio) * opening * opening)
    }
}

register! { CohesiveLawEntry "exponential",
    about: "traction that falls exponentially from the strength, both modes",
    source: "t = S exp(−(x − 1)/c); mixed mode: Benzeggagh and Kenane (1996)",
    defaults: include_str!("../../../../../configs/cohesive_laws/exponential.json"),
    build: |settings| Ok(Box::new(Exponential(MixedMode::of(settings)?))),
}
