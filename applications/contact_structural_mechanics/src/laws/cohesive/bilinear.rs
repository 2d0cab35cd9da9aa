//! Bilinear: traction that falls linearly with the opening, x = 1 at the onset of damage and x = r where the bond has failed.
//!
//! d = r (x − 1)/(x (r − 1)), r = G/e₀. A bond of damage d was opened by x = r/(r − d (r − 1)), and has dissipated e₀ d x.

use zelus_core::register;
use zelus_core::scalar::Real;

use super::mixed_mode::{ByMode, MixedMode};
use crate::law::{CohesiveLaw, CohesiveLawEntry};
use crate::mortar::Active;

struct Bilinear(MixedMode);

impl CohesiveLaw for Bilinear {
    fn stiffness(&self) -> [f64; 2] {
        self.0.stiffness
    }

    fn damage(&self, energies: [Active; 2]) -> Active {
        match self.0.at(energies) {
            Some(ByMode { ratio, opening, .. }) if opening.value() > 1.0 => softened(opening, ratio),
            _ => Active::zero(),
        }
    }

    fn dissipated(&self, energies: [f64; 2], damage: f64) -> f64 {
        self.0.at(energies).map_or(0.0, |ByMode { onset, ratio, .. }| onset * dissipated(damage, ratio))
    }
}

/// Damage at an opening, beyond 1, with this ratio of the energies of fracture and of the onset.
pub(super) fn softened(opening: Active, ratio: Active) -> Active {
    ratio * (opening - 1.0) / (opening * (ratio - 1.0))
}

/// Energy dissipated at a damage, over that at the onset.
pub(super) fn dissipated(damage: f64, ratio: f64) -> f64 {
    damage * ratio / (ratio - damage * (ratio - 1.0))
}

register! { CohesiveLawEntry "bilinear",
    about: "traction that falls linearly from the strength to zero, both modes",
    source: "Camanho, Dávila and de Moura (2003), Turon et al. (2006); mixed mode: Benzeggagh and Kenane (1996)",
    defaults: include_str!("../../../../../configs/cohesive_laws/bilinear.json"),
    build: |settings| Ok(Box::new(Bilinear(MixedMode::of(settings)?))),
}
