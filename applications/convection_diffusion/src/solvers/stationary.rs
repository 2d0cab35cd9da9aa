//! The solver of heat at rest.

use zelus_core::analysis::{SolverDefinition, SolverEntry};
use zelus_core::diagnostics::Diagnostic;
use zelus_core::register;

use crate::elements::AT_REST;
use crate::scheme::SCHEME;

register! { SolverEntry "stationary",
    aliases: &["Stationary"],
    about: "heat at rest at each time",
    defaults: include_str!("../../../../configs/solvers/stationary.json"),
    like: &[("kratos", include_str!("../../../../configs/like_kratos/stationary.json"))],
    build: SolverDefinition {
        variables: &super::VARIABLES,
        scheme: |_| Ok(SCHEME.to_owned()),
        adapt: super::adapt,
        adopt: |settings, part, report| {
            super::take_up(settings, [1.0, 0.0, 0.0, 0.0], part, report)?;
            let stores = settings.get_bool("stores_heat")?;
            part.info.marks.insert(AT_REST, !stores);
            if !stores {
                let fact = "heat at rest stores nothing, whatever \"time_step\" is";
                let remedy = "\"transient\" follows it in time; \"stores_heat\": true makes steps of the implicit Euler scheme, as Kratos does";
                report.push(Diagnostic::note("heat-at-rest", fact).remedy(remedy));
            }
            Ok(())
        },
        ..SolverDefinition::PLAIN
    },
}
