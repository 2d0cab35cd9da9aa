//! Coulomb friction by the augmented Lagrangian where every node in contact slides.

use zelus_core::register;
use zelus_core::registry::Build;

use super::alm_frictional::family;
use crate::pairs::Friction;

register! { Condition "ALMContactFrictionalPureSlip",
    about: "ALMContactFrictional without sticking: every node in contact slides",
    source: "eq. 4.9, D.11, D.13",
    build: Build::Factory(&family(Friction::PureSlip)),
}
