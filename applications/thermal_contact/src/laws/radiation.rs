//! Radiation between two faces that are near each other.

use zelus_core::register;
use zelus_core::scalar::Real;

use crate::law::{ByTemperatures, ConductanceLaw, ContactConductanceEntry, ContactPoint};

struct Radiation {
    /// ε σ.
    factor: f64,
}

impl ConductanceLaw for Radiation {
    fn conductance(&self, contact: &ContactPoint, [a, b]: [ByTemperatures; 2]) -> ByTemperatures {
        if contact.touches { ByTemperatures::constant(0.0) } else { (a * a + b * b) * (a + b) * self.factor }
    }

    fn acts_apart(&self) -> bool {
        true
    }
}

register! { ContactConductanceEntry "radiation",
    about: "radiation across the gap; temperatures in kelvin",
    source: "q = ε σ (T₁⁴ − T₂⁴) with 1/ε = 1/ε₁ + 1/ε₂ − 1",
    defaults: include_str!("../../../../configs/contact_conductances/radiation.json"),
    build: |settings| {
        let [a, b] = [settings.get_positive("emissivity_of_slave")?, settings.get_positive("emissivity_of_master")?];
        let factor = settings.get_positive("stefan_boltzmann_constant")? / (1.0 / a + 1.0 / b - 1.0);
        Ok(Box::new(Radiation { factor }))
    },
}
