//! Contact by Uzawa's iteration: that of the augmented Lagrangian without multipliers among the unknowns.

use zelus_core::register;
use zelus_core::registry::Build;

use super::alm_contact_process::{Stem, of_families};

const FAMILIES: Stem = Stem { name: "UzawaContact", penalty_factor: 1e1, least_penalty: 1.0 };

register! { Process "uzawa_contact_process",
    aliases: &["UzawaContactProcess"],
    about: "contact by Uzawa's iteration on the penalty kernel",
    source: "eqs. 4.11, D.10",
    defaults: include_str!("../../../../configs/processes/uzawa_contact_process.json"),
    like: &[("kratos", include_str!("../../../../configs/like_kratos/uzawa_contact_process.json"))],
    build: Build::Process(|request| of_families(request, &FAMILIES)),
}
