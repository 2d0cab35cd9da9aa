//! Pressure that grows exponentially: p = p₀/(e − 1) x (eˣ − 1), x = 1 + h/c, from the clearance c, with p₀ where surfaces touch.

use std::f64::consts::E;

use zelus_core::register;

use crate::law::{Overclosure, OverclosureLaw, OverclosureLawEntry};

/// Share of p₀ below which depth is linear in the pressure: at its beginning the law has no stiffness.
const LEAST: f64 = 1e-6;
/// Iterations that find a depth: from above they converge monotonically.
const ITERATIONS: usize = 60;

struct Exponential {
    /// p₀ > 0: where surfaces touch (force per area).
    pressure: f64,
    /// c > 0: at which contact begins (length).
    clearance: f64,
}

impl Exponential {
    /// x under a pressure, and dp/dx there.
    fn place(&self, pressure: f64) -> [f64; 2] {
        let share = pressure / self.pressure * (E - 1.0);
        let slope = |x: f64| x.exp_m1() + x * x.exp();
        // x (eˣ − 1) is convex and above x²; below the root of that is no start.
        let mut x = share.sqrt().min(1.0 + share.ln_1p());
        for _ in 0..ITERATIONS {
            let step = (x * x.exp_m1() - share) / slope(x);
            x -= step;
            if step.abs() <= f64::EPSILON * x {
                break;
            }
        }
        [x, slope(x) * self.pressure / (E - 1.0)]
    }
}

impl OverclosureLaw for Exponential {
    fn overclosure(&self, pressure: f64) -> Overclosure {
        let least = LEAST * self.pressure;
        if pressure <= least {
            let [x, _] = self.place(least);
            let compliance = self.clearance * x / least;
            return Overclosure { depth: compliance * pressure - self.clearance, compliance };
        }
        let [x, slope] = self.place(pressure);
        Overclosure { depth: self.clearance * (x - 1.0), compliance: self.clearance / slope }
    }
}

register! { OverclosureLawEntry "exponential",
    about: "pressure that grows exponentially from a clearance on",
    source: "p = p₀/(e − 1) x (eˣ − 1), x = 1 − g/c",
    defaults: include_str!("../../../../../configs/overclosure_laws/exponential.json"),
    build: |settings| {
        Ok(Box::new(Exponential {
            pressure: settings.get_positive("pressure")?,
            clearance: settings.get_positive("clearance")?,
        }))
    },
}
