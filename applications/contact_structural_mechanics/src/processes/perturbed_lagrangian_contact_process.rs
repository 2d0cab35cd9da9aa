//! Contact by the perturbed Lagrangian: the penalty method's answer with multipliers as unknowns.

use zelus_core::processes::ProcessEntry;
use zelus_core::register;

use super::alm_contact_process::{FormulationStem, of_formulations};

const FORMULATIONS: FormulationStem =
    FormulationStem { name: "PerturbedLagrangianContact", penalty_factor: 1e4, least_penalty: 1.0 };

register! { ProcessEntry "perturbed_lagrangian_contact_process",
    aliases: &["PerturbedLagrangianContactProcess"],
    about: "contact by the perturbed Lagrangian on mortar pairs",
    source: "eq. 4.11; Simo, Wriggers and Taylor (1985)",
    defaults: include_str!("../../../../configs/processes/perturbed_lagrangian_contact_process.json"),
    like: &[("kratos", include_str!("../../../../configs/like_kratos/perturbed_lagrangian_contact_process.json"))],
    build: |request| of_formulations(request, &FORMULATIONS),
    puts: "contact",
    surfaces: super::touching::contact,
}
