//! The solvers of structural problems, by `solver_type`.

mod dynamic_solver;
mod explicit_solver;
mod static_solver;

use zelus_core::analysis::NodalVariable;
use zelus_core::diagnostics::{Report, Result};
use zelus_core::model::ModelPart;
use zelus_core::parameters::{Defaults, Node, Settings, Value};

use crate::elements::BANDS_AS_KRATOS;

/// Settings of static solvers with their defaults.
pub const STATIC_DEFAULTS: &str = include_str!("../../../../configs/solvers/static.json");

/// Variables that every structural node has.
pub const VARIABLES: [NodalVariable; 8] = [
    ("DISPLACEMENT", 3),
    ("REACTION", 3),
    ("POSITIVE_FACE_PRESSURE", 1),
    ("NEGATIVE_FACE_PRESSURE", 1),
    ("POINT_LOAD", 3),
    ("LINE_LOAD", 3),
    ("SURFACE_LOAD", 3),
    ("VOLUME_ACCELERATION", 3),
];

/// Marks the settings that elements read.
///
/// # Errors
/// A name that is none.
pub fn adopt(settings: &Settings, part: &mut ModelPart, _report: &mut Report) -> Result<()> {
    let named = settings.get_str("crack_bands")?;
    if !matches!(named, "of_volume" | "as_kratos") {
        let problem = settings.error("crack_bands", "invalid-value", format!("\"crack_bands\" is \"{named}\""));
        return Err(problem.remedy("use \"of_volume\" or \"as_kratos\"").into());
    }
    part.info.set(BANDS_AS_KRATOS, named == "as_kratos");
    Ok(())
}

/// Names the spellings of older decks.
pub fn adapt(defaults: Defaults) -> Defaults {
    const WHOLE: &str = "the whole root part is computed";
    const BUILDER: &str = "results do not depend on the builder";
    defaults
        .require(&["model_part_name", "domain_size", "time_stepping", "model_import_settings"])
        .dropped("problem_domain_sub_model_part_list", WHOLE)
        .dropped("processes_sub_model_part_list", WHOLE)
        .dropped("use_computing_model_part", WHOLE)
        .dropped("computing_model_part_name", WHOLE)
        .dropped("builder_and_solver_settings.use_block_builder", BUILDER)
        .dropped("builder_and_solver_settings.use_lagrange_BS", BUILDER)
        .translated("block_builder", "builder_and_solver_settings", |value| match value {
            Value::Bool(true) => Some(typed("block")),
            Value::Bool(false) => Some(typed("elimination")),
            _ => None,
        })
        .translated("line_search", "solving_strategy_settings", |value| match value {
            Value::Bool(true) => Some(typed("line_search")),
            Value::Bool(false) => Some(typed("newton_raphson")),
            _ => None,
        })
}

fn typed(name: &str) -> Value {
    let place = zelus_core::diagnostics::Place::file("");
    Node::from_json(&serde_json::json!({ "type": name }), &place).map_or(Value::Null, |node| node.value)
}
