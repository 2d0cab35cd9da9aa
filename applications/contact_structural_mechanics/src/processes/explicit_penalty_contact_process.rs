//! Contact by the penalty method in explicit steps, which stiffen the penalty with the gap.

use zelus_core::processes::ProcessEntry;
use zelus_core::register;

use super::alm_contact_process::{FormulationStem, of_formulations};

/// The formulations of the penalty method; a penalty as stiff as elements leaves explicit steps their length.
const EXPLICIT: FormulationStem = FormulationStem { name: "PenaltyContact", penalty_factor: 1.0, least_penalty: 1e13 };

register! { ProcessEntry "explicit_penalty_contact_process",
    aliases: &["ExplicitPenaltyContactProcess"],
    about: "contact by the penalty method on mortar pairs, in explicit steps",
    source: "eqs. 4.11, D.3",
    defaults: include_str!("../../../../configs/processes/explicit_penalty_contact_process.json"),
    like: &[("kratos", include_str!("../../../../configs/like_kratos/explicit_penalty_contact_process.json"))],
    build: |request| of_formulations(request, &EXPLICIT),
    puts: "contact",
    surfaces: super::touching::contact,
}
