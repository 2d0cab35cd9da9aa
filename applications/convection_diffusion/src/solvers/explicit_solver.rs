//! The solver of heat in explicit steps: "transient" with `time_integration_method` "explicit".

use zelus_core::analysis::{SolverDefinition, SolverEntry};
use zelus_core::register;

use crate::scheme::SCHEME;

/// Name of the solver.
pub(super) const EXPLICIT_TRANSIENT: &str = "ExplicitTransient";

register! { SolverEntry EXPLICIT_TRANSIENT,
    about: "as \"transient\" with \"time_integration_method\": \"explicit\": short steps without a linear system",
    source: "ρc (∂T/∂t + v·∇T) = ∇·(k ∇T) + Q",
    defaults: include_str!("../../../../configs/solvers/explicit_transient.json"),
    like: &[("kratos", include_str!("../../../../configs/like_kratos/explicit_transient.json"))],
    build: SolverDefinition {
        variables: &super::VARIABLES,
        scheme: |_| Ok(SCHEME.to_owned()),
        adapt: super::adapt,
        adopt: |settings, part, report| {
            super::take_up(settings, [1.0, settings.get_f64("dynamic_tau")?, 0.0, 0.0], part, report)?;
            crate::adoption::warn_of_no_storage(part, "it is taken as 1", report);
            Ok(())
        },
        ..SolverDefinition::PLAIN
    },
}
