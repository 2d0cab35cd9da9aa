//! The solver of steady-state heat transfer.

use zelus_core::analysis::{SolverDefinition, SolverEntry};
use zelus_core::register;

use crate::elements::AT_REST;
use crate::scheme::SCHEME;

register! { SolverEntry "stationary",
    aliases: &["Stationary"],
    about: "steady-state heat transfer at each time; with elements that store heat, a step of the implicit Euler scheme, which must be long",
    source: "ρc v·∇T = ∇·(k ∇T) + Q",
    defaults: include_str!("../../../../configs/solvers/stationary.json"),
    like: &[("kratos", include_str!("../../../../configs/like_kratos/stationary.json"))],
    build: SolverDefinition {
        variables: &super::VARIABLES,
        long_step: true,
        scheme: |_| Ok(SCHEME.to_owned()),
        adapt: super::adapt,
        adopt: |settings, part, report| {
            super::take_up(settings, [1.0, 0.0, 0.0, 0.0], part, report)?;
            part.info.set(AT_REST, !settings.get_bool("stores_heat")?);
            Ok(())
        },
        ..SolverDefinition::PLAIN
    },
}
