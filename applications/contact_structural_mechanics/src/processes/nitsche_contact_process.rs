//! Contact by Nitsche's method: the stresses of the slave body in the place of multipliers.

use zelus_core::processes::ProcessEntry;
use zelus_core::register;

use super::alm_contact_process::{FormulationStem, of_formulations};

const NITSCHE: FormulationStem = FormulationStem { name: "NitscheContact", penalty_factor: 1.0, least_penalty: 1.0 };

register! { ProcessEntry "nitsche_contact_process",
    aliases: &["NitscheContactProcess"],
    about: "contact by Nitsche's method on mortar segments",
    source: "Chouly, Hild and Renard (2015)",
    defaults: include_str!("../../../../configs/processes/nitsche_contact_process.json"),
    build: |request| of_formulations(request, &NITSCHE),
    puts: "contact",
    surfaces: super::touching::contact,
}
