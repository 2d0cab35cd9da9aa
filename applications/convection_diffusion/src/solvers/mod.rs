//! The solvers of heat, by `solver_type`.

mod explicit_solver;
mod stationary_solver;
mod thermo_mechanically_coupled;
mod transient_solver;

use zelus_core::analysis::NodalVariable;
use zelus_core::diagnostics::{Report, Result};
use zelus_core::model::ModelPart;
use zelus_core::parameters::{Defaults, Node, Settings, Value};

use crate::adoption;
use crate::elements::{AT_CENTRE, AT_REST, CROSS_WIND, DYNAMIC_TAU, LEAST_GRADIENT, THETA};

/// Variables that every node has; further ones are those that the deck names.
const VARIABLES: [NodalVariable; 2] = [("TEMPERATURE", 1), ("REACTION_FLUX", 1)];

/// Takes up the part, with the weight of the end of a step, β, and factor and least gradient of cross-wind diffusion.
fn take_up(
    settings: &Settings,
    [theta, tau, cross_wind, least]: [f64; 4],
    part: &mut ModelPart,
    report: &mut Report,
) -> Result<()> {
    adoption::adopt(settings, part, report)?;
    part.info.values.extend([(THETA, theta), (DYNAMIC_TAU, tau), (CROSS_WIND, cross_wind), (LEAST_GRADIENT, least)]);
    part.info.set(AT_REST, false);
    part.info.set(AT_CENTRE, settings.node().get("gradients").and_then(Node::as_str) == Some("at_centre"));
    Ok(())
}

/// Names the spellings of older decks.
fn adapt(defaults: Defaults) -> Defaults {
    const WHOLE: &str = "the whole root part is computed";
    defaults
        .require(&["model_part_name", "domain_size", "time_stepping", "model_import_settings"])
        .dropped("problem_domain_sub_model_part_list", WHOLE)
        .dropped("processes_sub_model_part_list", WHOLE)
        .translated("block_builder", "builder_and_solver_settings", |value| chosen(value, ["elimination", "block"]))
        .translated("line_search", "solving_strategy_settings", |value| {
            chosen(value, ["newton_raphson", "line_search"])
        })
}

/// The object that names one of two types.
fn chosen(value: &Value, [no, yes]: [&str; 2]) -> Option<Value> {
    let Value::Bool(value) = value else { return None };
    let place = zelus_core::diagnostics::Place::file("");
    Node::from_json(&serde_json::json!({ "type": if *value { yes } else { no } }), &place).ok().map(|node| node.value)
}
