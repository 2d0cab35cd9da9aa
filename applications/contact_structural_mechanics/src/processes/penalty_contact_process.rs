//! Contact by the penalty method: that of the augmented Lagrangian with a stiffer spring and without multipliers.

use zelus_core::processes::ProcessEntry;
use zelus_core::register;

use super::alm_contact_process::{FormulationStem, of_formulations};

/// A spring stiff enough to hold surfaces apart alone.
const PENALTY: FormulationStem = FormulationStem { name: "PenaltyContact", penalty_factor: 1e4, least_penalty: 1e16 };

register! { ProcessEntry "penalty_contact_process",
    aliases: &["PenaltyContactProcess"],
    about: "contact by the penalty method on mortar pairs",
    source: "eqs. 4.11, D.3",
    defaults: include_str!("../../../../configs/processes/penalty_contact_process.json"),
    like: &[("kratos", include_str!("../../../../configs/like_kratos/penalty_contact_process.json"))],
    build: |request| of_formulations(request, &PENALTY),
    puts: "contact",
    surfaces: super::touching::contact,
}
