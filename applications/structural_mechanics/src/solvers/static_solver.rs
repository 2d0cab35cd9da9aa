//! The solver of static problems.

use zelus_core::analysis::{SolverDefinition, SolverEntry};
use zelus_core::register;

register! { SolverEntry "Static",
    aliases: &["static"],
    about: "static equilibrium at each time; time is the load factor",
    source: "f_int(u) = f_ext(t)",
    defaults: super::STATIC_DEFAULTS,
    like: &[("kratos", include_str!("../../../../configs/like_kratos/static.json"))],
    build: SolverDefinition {
        variables: &super::VARIABLES,
        scheme: |_| Ok("static".to_owned()),
        adapt: super::adapt,
        adopt: super::adopt,
        ..SolverDefinition::PLAIN
    },
}
