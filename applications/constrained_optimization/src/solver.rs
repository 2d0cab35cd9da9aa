//! The solver of problems whose only unknowns are positions and multipliers.

use zelus_core::analysis::{SolverDefinition, SolverEntry};
use zelus_core::register;

register! { SolverEntry "ConstrainedOptimization",
    aliases: &["constrained_optimization"],
    about: "minimum of the energy of springs under constraints, by Newton's method",
    source: "eqs. D.2, D.5c",
    defaults: include_str!("../../../configs/solvers/constrained_optimization.json"),
    build: SolverDefinition {
        variables: &[("POSITION", 1)],
        scheme: |_| Ok("static".to_owned()),
        adapt: |defaults| defaults.require(&["model_part_name", "model_import_settings"]),
        ..SolverDefinition::PLAIN
    },
}
