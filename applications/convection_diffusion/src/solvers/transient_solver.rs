//! The solver of transient heat transfer.

use zelus_core::analysis::{SolverDefinition, SolverEntry};
use zelus_core::parameters::Node;
use zelus_core::register;

use super::explicit_solver::EXPLICIT_TRANSIENT;
use crate::adoption::warn_of_no_storage;
use crate::elements::{CROSS_WIND_OF_ITERATE, CROSS_WIND_OF_STEP_START, PURE_CONVECTION};
use crate::scheme::SCHEME;
use crate::semi_implicit::SEMI_IMPLICIT;

register! { SolverEntry "transient",
    aliases: &["Transient"],
    about: "transient heat transfer: storage, conduction, convection, exchange with the surroundings",
    source: "ρc (∂T/∂t + v·∇T) = ∇·(k ∇T) + Q",
    defaults: include_str!("../../../../configs/solvers/transient.json"),
    like: &[("kratos", include_str!("../../../../configs/like_kratos/transient.json"))],
    build: SolverDefinition {
        variant: |user| {
            let method = user.get("time_integration_method").and_then(Node::as_str);
            (method == Some("explicit")).then_some(EXPLICIT_TRANSIENT)
        },
        variables: &super::VARIABLES,
        long_step: true,
        scheme: |settings| {
            let method = settings.get_str("time_integration_method")?;
            match method {
                "implicit" => return Ok(SCHEME.to_owned()),
                "semi_implicit" => return Ok(SEMI_IMPLICIT.to_owned()),
                _ => {}
            }
            let problem = settings.error("time_integration_method", "time-integration", format!("\"time_integration_method\" is \"{method}\""));
            Err(problem.remedy("use \"implicit\", \"semi_implicit\" or \"explicit\"").into())
        },
        adapt: super::adapt,
        adopt: |settings, part, report| {
            let read = |key: &str| settings.get_f64(&format!("transient_parameters.{key}"));
            let theta = read("theta")?;
            if !(0.5..=1.0).contains(&theta) {
                let problem = settings.error("transient_parameters.theta", "invalid-value", format!("\"theta\" is {theta}"));
                return Err(problem.remedy("from 0.5, of second order, to 1: below, steps must be short to be stable").into());
            }
            let cross_wind = ["cross_wind_stabilization_factor", "cross_wind_least_gradient"];
            let parameters = [theta, read("dynamic_tau")?, read(cross_wind[0])?, read(cross_wind[1])?];
            super::take_up(settings, parameters, part, report)?;
            let state = settings.get_str("transient_parameters.linear_cross_wind")?;
            let linear = settings.get_str("analysis_type")? == "linear";
            part.info.set(CROSS_WIND_OF_ITERATE, linear && state == "of_iterate");
            part.info.set(CROSS_WIND_OF_STEP_START, linear && state == "of_step_start");
            part.info.set(PURE_CONVECTION, settings.get_bool("pure_convection")?);
            warn_of_no_storage(part, "unless a process sets it, they store no heat", report);
            Ok(())
        },
        ..SolverDefinition::PLAIN
    },
}
