//! Radiation between two faces that are near each other.

use zelus_core::register;
use zelus_core::scalar::Real;

use crate::law::{ByTemperatures, ConductanceLaw, ContactConductanceEntry, ContactPoint};

struct Radiation {
    /// Emissivities of slave and master.
    emissivities: [f64; 2],
    /// σ.
    constant: f64,
}

impl ConductanceLaw for Radiation {
    fn conductance(&self, contact: &ContactPoint, [a, b]: [ByTemperatures; 2]) -> ByTemperatures {
        if contact.touches {
            return ByTemperatures::constant(0.0);
        }
        let ([slave, master], [of_slave, of_master]) = (contact.areas, self.emissivities);
        let exchanged = if slave <= master {
            slave / (1.0 / of_slave + slave / master * (1.0 / of_master - 1.0))
        } else {
            master / (1.0 / of_master + master / slave * (1.0 / of_slave - 1.0))
        };
        (a * a + b * b) * (a + b) * (self.constant * exchanged)
    }

    fn acts_apart(&self) -> bool {
        true
    }
}

register! { ContactConductanceEntry "radiation",
    about: "radiation across the gap; temperatures in kelvin",
    source: "q = ε σ (T₁⁴ − T₂⁴) per area of the inner face 1, with 1/ε = 1/ε₁ + A₁/A₂ (1/ε₂ − 1)",
    defaults: include_str!("../../../../configs/contact_conductances/radiation.json"),
    build: |settings| {
        Ok(Box::new(Radiation {
            emissivities: [settings.get_positive("emissivity_of_slave")?, settings.get_positive("emissivity_of_master")?],
            constant: settings.get_positive("stefan_boltzmann_constant")?,
        }))
    },
}
