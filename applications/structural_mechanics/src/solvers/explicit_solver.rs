//! The solver of explicit dynamics: `solver_type` "Dynamic" with `time_integration_method` "explicit".

use zelus_core::analysis::{SolverDefinition, SolverEntry};
use zelus_core::register;

register! { SolverEntry "ExplicitDynamic",
    about: "as \"Dynamic\" with \"time_integration_method\": \"explicit\": short steps without iterations",
    source: "M a + C v + f_int(u) = f_ext(t)",
    defaults: include_str!("../../../../configs/solvers/explicit_dynamic.json"),
    like: &[("kratos", include_str!("../../../../configs/like_kratos/explicit_dynamic.json"))],
    build: SolverDefinition {
        variables: &super::dynamic_solver::VARIABLES,
        explicit: true,
        adapt: super::adapt,
        adopt: super::adopt,
        ..SolverDefinition::PLAIN
    },
}
