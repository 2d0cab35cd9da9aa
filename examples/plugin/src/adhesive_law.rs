//! Friction with adhesion: surfaces bear a traction even where nothing presses them together.
//!
//! |t| ≤ c − μ p with c = ADHESION (force per area) and μ = 0.2; the pressure p is negative in compression.

use zelus::contact_structural_mechanics::law::{Bound, FrictionLaw, FrictionLawEntry};
use zelus::contact_structural_mechanics::laws::friction::COULOMB;
use zelus_core::{register, register_variable};

register_variable! {
    pub ADHESION: f64 = "Tangential traction that surfaces bear without pressure (force per area).";
}

register! { FrictionLawEntry "Adhesive",
    about: "limit of the tangential traction: ADHESION and a fifth of the pressure",
    source: "|t| ≤ c − μ p",
    build: FrictionLaw {
        strengths: &[&ADHESION],
        bound: |numbers, _| Bound { coefficient: 0.2, threshold: numbers[0] },
        by_coefficients: false,
        ..COULOMB
    },
}
