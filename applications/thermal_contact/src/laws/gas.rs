//! Conduction through the gas between two bodies.

use zelus_core::register;
use zelus_core::scalar::Real;

use crate::law::{ByTemperatures, ConductanceLaw, ContactConductanceEntry, ContactPoint};

struct Gas {
    conductivity: f64,
    jump: f64,
}

impl ConductanceLaw for Gas {
    fn conductance(&self, contact: &ContactPoint, _temperatures: [ByTemperatures; 2]) -> ByTemperatures {
        ByTemperatures::constant(self.conductivity / (contact.gap + self.jump))
    }

    fn acts_apart(&self) -> bool {
        true
    }
}

register! { ContactConductanceEntry "gas",
    about: "conduction through the gas in the gap, and in the pits of surfaces that touch",
    source: "q = k/(g + g₀) (T₁ − T₂)",
    defaults: include_str!("../../../../configs/contact_conductances/gas.json"),
    build: |settings| {
        Ok(Box::new(Gas {
            conductivity: settings.get_positive("conductivity")?,
            jump: settings.get_positive("jump_distance")?,
        }))
    },
}
