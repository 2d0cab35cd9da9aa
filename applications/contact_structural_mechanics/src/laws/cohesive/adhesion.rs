//! Adhesion: a bond against pull alone, bilinear; friction acts on the whole surface as without bond.

use zelus_core::register;
use zelus_core::scalar::Real;

use super::bilinear::{dissipated, softened};
use super::mixed_mode::check_energy;
use crate::law::{CohesiveLaw, CohesiveLawEntry};
use crate::mortar::Active;

struct Adhesion {
    /// K_n (stress by length).
    stiffness: f64,
    /// Energy by area at the onset of damage.
    onset: f64,
    /// Energy of fracture over that.
    ratio: f64,
}

impl CohesiveLaw for Adhesion {
    fn stiffness(&self) -> [f64; 2] {
        [self.stiffness, 0.0]
    }

    fn damage(&self, [normal, _]: [Active; 2]) -> Active {
        if normal.value() <= self.onset {
            return Active::zero();
        }
        softened((normal / self.onset).sqrt(), Active::constant(self.ratio))
    }

    fn dissipated(&self, _: [f64; 2], damage: f64) -> f64 {
        self.onset * dissipated(damage, self.ratio)
    }
}

register! { CohesiveLawEntry "adhesion",
    about: "bond against pull alone, with friction as without bond",
    source: "t_n falls linearly from the strength to zero",
    defaults: include_str!("../../../../../configs/cohesive_laws/adhesion.json"),
    build: |settings| {
        let [stiffness, strength, energy] =
            [settings.get_positive("normal_stiffness")?, settings.get_positive("normal_strength")?, settings.get_positive("normal_energy")?];
        let onset = 0.5 * strength * strength / stiffness;
        check_energy(settings, "normal", (onset, energy))?;
        Ok(Box::new(Adhesion { stiffness, onset, ratio: energy / onset }))
    },
}
