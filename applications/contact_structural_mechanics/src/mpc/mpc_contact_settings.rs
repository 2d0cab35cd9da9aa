//! `mpc_contact_settings` of the solver: contact by constraints needs no unknowns of its own.

use zelus_core::analysis::{ExtensionDefinition, SolverExtensionEntry};
use zelus_core::model::ProcessInfo;
use zelus_core::register;

use super::mpc_kind::{MpcKind, mpc_contact_type};
use crate::solver::{IMPACT_NUMBERS, marks_of_words};

/// Mark of the step data: relations are made anew in every iteration.
const UPDATE_EACH_ITERATION: &str = "UPDATE_EACH_NL_ITERATION";

/// Whether the solver of a part asks for new relations in every iteration.
pub fn updates_each_iteration(info: &ProcessInfo) -> bool {
    info.is(UPDATE_EACH_ITERATION)
}

register! { SolverExtensionEntry "mpc_contact_settings",
    about: "settings of contact by constraints at the solver",
    defaults: include_str!("../../../../configs/solvers/mpc_contact_settings.json"),
    like: &[("kratos", include_str!("../../../../configs/like_kratos/mpc_contact_settings.json"))],
    build: ExtensionDefinition {
        variables: |settings| {
            let mut variables = vec![("NORMAL", 3), ("WEIGHTED_GAP", 1)];
            if mpc_contact_type(settings)?.0 == MpcKind::Frictional {
                variables.push(("WEIGHTED_SLIP", 3));
            }
            Ok(variables)
        },
        marks: |settings| {
            let update = settings.get_bool("update_each_nl_iteration")?;
            Ok(update.then_some(UPDATE_EACH_ITERATION).into_iter().chain(marks_of_words(settings)?).collect())
        },
        cutting: |_| Ok(None),
        values: |settings| IMPACT_NUMBERS.into_iter().map(|(key, name)| Ok((name, settings.get_f64(key)?))).collect(),
        ..ExtensionDefinition::NOTHING
    },
}
