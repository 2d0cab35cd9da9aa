//! Contact by Uzawa's iteration, with the settings of the augmented Lagrangian.

use zelus_core::processes::ProcessEntry;
use zelus_core::register;

use super::alm_contact_process::{FormulationStem, of_formulations};

const FORMULATIONS: FormulationStem = FormulationStem { name: "UzawaContact", penalty_factor: 1e1, least_penalty: 1.0 };

register! { ProcessEntry "uzawa_contact_process",
    aliases: &["UzawaContactProcess"],
    about: "contact by Uzawa's iteration: regularised multipliers, and an outer loop that removes the remaining penetration",
    source: "eqs. 4.11, D.10",
    defaults: include_str!("../../../../configs/processes/uzawa_contact_process.json"),
    like: &[("kratos", include_str!("../../../../configs/like_kratos/uzawa_contact_process.json"))],
    build: |request| of_formulations(request, &FORMULATIONS),
    puts: "contact",
    surfaces: super::touching::contact,
}
