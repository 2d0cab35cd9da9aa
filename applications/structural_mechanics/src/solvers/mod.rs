//! The solvers of structural problems, by `solver_type`.

mod dynamic_solver;
mod explicit_solver;
mod static_solver;

use std::collections::BTreeMap;

use zelus_core::analysis::NodalVariable;
use zelus_core::diagnostics::{Diagnostic, Report, Result};
use zelus_core::model::{ModelPart, Properties};
use zelus_core::parameters::{Defaults, Node, Settings, Value};
use zelus_core::registry::{all, find};

use crate::elements::BANDS_AS_KRATOS;
use crate::laws::LawEntry;

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
pub fn adopt(settings: &Settings, part: &mut ModelPart, report: &mut Report) -> Result<()> {
    warn_of_constants(part, report);
    let named = settings.get_str("crack_bands")?;
    if !matches!(named, "of_volume" | "as_kratos") {
        let problem = settings.error("crack_bands", "invalid-value", format!("\"crack_bands\" is \"{named}\""));
        return Err(problem.remedy("use \"of_volume\" or \"as_kratos\"").into());
    }
    part.info.set(BANDS_AS_KRATOS, named == "as_kratos");
    Ok(())
}

/// Warns of constants of elements' properties that their law does not take, and others do, and of constants with which it is not stable.
fn warn_of_constants(part: &ModelPart, report: &mut Report) {
    let mut first: BTreeMap<usize, usize> = BTreeMap::new();
    part.elements.properties.iter().zip(&part.elements.ids).for_each(|(of, id)| {
        first.entry(*of).or_insert(*id);
    });
    let mut of_layers: Vec<(&Properties, usize)> =
        first.iter().filter_map(|(of, id)| Some((part.properties.get(of)?, *id))).collect();
    while let Some((properties, element)) = of_layers.pop() {
        of_layers.extend(properties.parts.iter().map(|layer| (layer, element)));
        let Some(law) = properties.law.as_deref().and_then(find::<LawEntry>) else { continue };
        (law.warns)(properties, element).into_iter().for_each(|problem| report.push(problem));
        let tables = properties.tables.keys().map(|(_, of)| of);
        for name in properties.values.keys().chain(tables).filter(|name| !law.takes_constant(name)) {
            let Some(other) = all::<LawEntry>().into_iter().find(|other| other.takes_constant(name)) else { continue };
            let fact = format!("{name} of properties {} is not read: {} does not take it", properties.id, law.name);
            let remedy = format!("remove it, or name a law that takes it, such as {}", other.name);
            let problem = Diagnostic::warning("variable-without-effect", fact).at(properties.place.clone());
            report.push(problem.remedy(remedy));
        }
    }
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
