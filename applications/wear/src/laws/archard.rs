//! Archard's law: the worn volume is proportional to force and way.
//!
//! J. F. Archard, J. Appl. Phys. 24 (1953): V = K F s / H, hence the depth K/H p s of a point.

use zelus_core::register;

use crate::law::{SlidingStep, WearLaw, WearLawEntry};

struct Archard {
    /// K/H (area per force).
    factor: f64,
}

impl WearLaw for Archard {
    fn depth(&self, sliding: &SlidingStep) -> f64 {
        self.factor * sliding.pressure * sliding.slip
    }
}

register! { WearLawEntry "archard",
    about: "worn depth: pressure times sliding distance over hardness",
    source: "K/H p s; Archard (1953)",
    defaults: include_str!("../../../../configs/wear_laws/archard.json"),
    build: |settings| {
        let factor = settings.get_positive("wear_coefficient")? / settings.get_positive("hardness")?;
        Ok(Box::new(Archard { factor }))
    },
}
