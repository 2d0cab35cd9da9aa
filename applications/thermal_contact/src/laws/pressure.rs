//! Conductance of rough surfaces, which touch on the more spots the harder they are pressed.
//!
//! Cooper, Mikic and Yovanovich, Int. J. Heat Mass Transfer 12 (1969): h = 1.25 k m/σ (p/H)^0.95, with the harmonic mean k of both
//! conductivities, slope m and height σ of the roughness, and the hardness H of the softer body.

use zelus_core::register;
use zelus_core::scalar::Real;

use crate::law::{ByTemperatures, ConductanceLaw, ContactConductanceEntry, ContactPoint};

struct ByPressure {
    conductance: f64,
    hardness: f64,
    exponent: f64,
}

impl ConductanceLaw for ByPressure {
    fn conductance(&self, contact: &ContactPoint, _temperatures: [ByTemperatures; 2]) -> ByTemperatures {
        let share = (contact.pressure / self.hardness).max(0.0);
        ByTemperatures::constant(self.conductance * share.powf(self.exponent))
    }
}

register! { ContactConductanceEntry "pressure",
    about: "conductance by a power of the pressure over the hardness, as of rough surfaces",
    source: "q = h₀ (p/H)ⁿ (T₁ − T₂); Cooper, Mikic and Yovanovich (1969)",
    defaults: include_str!("../../../../configs/contact_conductances/pressure.json"),
    build: |settings| {
        Ok(Box::new(ByPressure {
            conductance: settings.get_positive("conductance")?,
            hardness: settings.get_positive("hardness")?,
            exponent: settings.get_positive("exponent")?,
        }))
    },
}
