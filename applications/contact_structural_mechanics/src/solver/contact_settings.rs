//! `contact_settings` of the solver: the family decides which variables the nodes carry.

use zelus_core::analysis::ExtensionDefinition;
use zelus_core::register;
use zelus_core::registry::Build;

use crate::pairs::variables_of;

register! { SolverExtension "contact_settings",
    about: "what the solver needs to know of contact",
    defaults: include_str!("../../../../configs/solvers/contact_settings.json"),
    build: Build::Factory(&ExtensionDefinition {
        variables: |settings| {
            let mortar_type = settings.get_str("mortar_type")?;
            if mortar_type.is_empty() {
                return Ok(Vec::new());
            }
            let variables = variables_of(mortar_type).map_err(|d| d.at(settings.key_place("mortar_type")))?;
            Ok(variables.to_vec())
        },
    }),
}
