//! Coulomb friction by the augmented Lagrangian where every node in contact slides.

use crate::pairs::FamilyEntry;
use zelus_core::register;

use super::alm_frictional::family;
use crate::pairs::Friction;

register! { FamilyEntry "ALMContactFrictionalPureSlip",
    about: "ALMContactFrictional without sticking: every node in contact slides",
    source: "eq. 4.9, D.11, D.13",
    build: family(Friction::PureSlip),
}
