//! The solver of problems with inertia.

use zelus_core::analysis::{NodalVariable, SolverDefinition, SolverEntry};
use zelus_core::register;

pub(super) const VARIABLES: [NodalVariable; 10] = {
    let [a, b, c, d, e, f, g, h] = super::VARIABLES;
    [a, b, c, d, e, f, g, h, ("VELOCITY", 3), ("ACCELERATION", 3)]
};

register! { SolverEntry "Dynamic",
    aliases: &["dynamic"],
    about: "motion with inertia, integrated in time by a scheme",
    source: "M a + C v + f_int(u) = f_ext(t)",
    defaults: include_str!("../../../../configs/solvers/dynamic.json"),
    like: &[("kratos", include_str!("../../../../configs/like_kratos/dynamic.json"))],
    build: SolverDefinition {
        variant: |user| {
            let method = user.get("time_integration_method").and_then(|method| method.str().ok());
            (method == Some("explicit")).then_some("ExplicitDynamic")
        },
        variables: &VARIABLES,
        scheme: |settings| {
            let method = settings.get_str("time_integration_method")?;
            if method != "implicit" {
                let fact = format!("\"time_integration_method\" is \"{method}\"");
                return Err(settings
                    .error("time_integration_method", "time-integration", fact)
                    .remedy("use \"implicit\" or \"explicit\"")
                    .into());
            }
            // A deck that names a parameter of Bossak's scheme only means that scheme.
            if settings.is_given("damp_factor_m") && !settings.is_given("scheme_type") {
                return Ok("bossak".to_owned());
            }
            settings.get_str("scheme_type").map(str::to_owned)
        },
        adapt: super::adapt,
        adopt: super::adopt,
        ..SolverDefinition::PLAIN
    },
}
