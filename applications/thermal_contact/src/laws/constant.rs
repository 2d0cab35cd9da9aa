//! The same conductance wherever bodies touch.

use zelus_core::register;
use zelus_core::scalar::Real;

use crate::law::{ByTemperatures, ConductanceLaw, ContactConductanceEntry, ContactPoint};

struct Constant(f64);

impl ConductanceLaw for Constant {
    fn conductance(&self, contact: &ContactPoint, _temperatures: [ByTemperatures; 2]) -> ByTemperatures {
        ByTemperatures::constant(if contact.touches { self.0 } else { 0.0 })
    }
}

register! { ContactConductanceEntry "constant",
    about: "the same conductance wherever bodies touch",
    source: "q = h (T₁ − T₂)",
    defaults: include_str!("../../../../configs/contact_conductances/constant.json"),
    build: |settings| Ok(Box::new(Constant(settings.get_positive("conductance")?))),
}
