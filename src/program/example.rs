//! Examples of use: how a deck, a mesh or a file of materials names an object.

use serde_json::{Value, json};
use zelus_core::Result;
use zelus_core::entities::find_kind;
use zelus_core::model::EntityRole;
use zelus_core::parameters::Defaults;
use zelus_core::registry::{Entry, find};
use zelus_structural_mechanics::laws::LawEntry;

/// Kinds that a deck names by a word, with the path of that word.
const WORDS: [(&str, &str); 9] = [
    ("scheme", "solver_settings.scheme_type"),
    ("convergence_criterion", "solver_settings.convergence_criterion"),
    ("builder_and_solver", "solver_settings.builder_and_solver_settings.type"),
    ("linear_solver", "solver_settings.linear_solver_settings.solver_type"),
    ("preconditioner", "solver_settings.linear_solver_settings.preconditioner_type"),
    ("contact_formulation", "solver_settings.contact_settings.mortar_type"),
    ("tying_formulation", "solver_settings.contact_settings.mortar_type"),
    ("friction_law", "Parameters.frictional_law"),
    ("output_format", "Parameters.file_format"),
];

/// How the object is named, as text of the file that names it; `None` where nothing names objects of its kind.
///
/// # Errors
/// Defaults that cannot be read.
pub(super) fn example(kind: &str, entry: &Entry) -> Result<Option<String>> {
    let settings = match entry.defaults {
        "" => None,
        text => Defaults::parse(entry.name, text)?.example().map(zelus_core::parameters::Node::to_json),
    };
    let name = entry.name;
    let role = [EntityRole::Element, EntityRole::Condition].into_iter().find(|role| role.word() == kind);
    if let Some(role) = role {
        let Some(nodes) = find_kind(role, name).map(|kind| kind.nodes()) else { return Ok(None) };
        let numbers: Vec<String> = (1..=nodes).map(|node| node.to_string()).collect();
        let block = if role == EntityRole::Element { "Elements" } else { "Conditions" };
        return Ok(Some(format!("Begin {block} {name}\n    1 1 {}\nEnd {block}", numbers.join(" "))));
    }
    let settings = settings.unwrap_or_else(|| json!({}));
    let named = match kind {
        "process" => json!({ "python_module": name, "Parameters": settings }),
        "modeler" => json!({ "name": name, "parameters": settings }),
        "solver" => json!({ "solver_settings": settings }),
        "solver_extension" => at(&format!("solver_settings.{name}"), settings),
        "strategy" => {
            at("solver_settings.solving_strategy_settings", json!({ "type": name, "advanced_settings": settings }))
        }
        "contact_conductance" => at("Parameters.conductance", json!([settings])),
        "overclosure_law" => at("Parameters.pressure_overclosure", settings),
        "cohesive_law" => at("Parameters.cohesive", settings),
        "wear_law" => at("Parameters.wear_of_slave", json!([settings])),
        "rigid_shape" => at("Parameters.shape", settings),
        "penalty_adaptation" => {
            at("Parameters.advance_ALM_parameters", json!({ "adapt_penalty": true, "adaptation_rule": name }))
        }
        "mesh_format" => {
            let mut import = json!({ "input_type": name, "input_filename": "part" });
            settings.as_object().into_iter().flatten().for_each(|(key, value)| import[key] = value.clone());
            at("solver_settings.model_import_settings", import)
        }
        "constitutive_law" => json!({
            "model_part_name": "Structure.Body",
            "properties_id": 1,
            "Material": {
                "constitutive_law": { "name": name },
                "Variables": constants_of(name)
            }
        }),
        _ => match WORDS.iter().find(|(word, _)| *word == kind) {
            Some((_, path)) => at(path, json!(name)),
            None => return Ok(None),
        },
    };
    Ok(Some(format!("{named:#}")))
}

/// Constants of laws that are not isotropic elasticity, with usual values (MPa, hours): an example has those that its law takes.
const CONSTANTS: [(&str, f64); 19] = [
    ("YOUNG_MODULUS_X", 140_000.0),
    ("YOUNG_MODULUS_Y", 10_000.0),
    ("YOUNG_MODULUS_Z", 10_000.0),
    ("POISSON_RATIO_XY", 0.3),
    ("POISSON_RATIO_YZ", 0.4),
    ("POISSON_RATIO_XZ", 0.3),
    ("SHEAR_MODULUS_XY", 5_000.0),
    ("SHEAR_MODULUS_YZ", 3_500.0),
    ("SHEAR_MODULUS_XZ", 5_000.0),
    ("NORTON_COEFFICIENT", 1e-16),
    ("NORTON_EXPONENT", 5.0),
    ("YIELD_STRESS", 250.0),
    ("SHEAR_MODULUS", 0.7),
    ("C10", 0.3),
    ("C01", 0.05),
    ("C30", 0.001),
    ("GENT_LIMIT", 60.0),
    ("LOCKING_STRETCH", 5.0),
    ("BULK_MODULUS", 700.0),
];

/// Constants of a material with the law of that name.
fn constants_of(law: &str) -> Value {
    let takes = |name: &str| find::<LawEntry>(law).is_some_and(|law| law.takes_constant(name));
    if takes("UDSM_NAME") {
        return json!({ "UDSM_NAME": "libumat.so", "UMAT_PARAMETERS": [210_000.0, 0.3], "STATE_VARIABLES": [0.0] });
    }
    if takes("LAW_FUNCTION") {
        return json!({ "LAW_FUNCTION": "my_law", "LAW_PARAMETERS": [210_000.0, 0.3] });
    }
    let mut constants = json!({});
    let is_rubber = takes("BULK_MODULUS") || takes("BLATZ_KO_SHARE");
    if is_rubber && !takes("BULK_MODULUS") {
        constants = json!({ "POISSON_RATIO": 0.25 });
    }
    if !takes("YOUNG_MODULUS_X") && !is_rubber {
        constants = json!({ "YOUNG_MODULUS": 210_000.0, "POISSON_RATIO": 0.3 });
    }
    for (name, value) in CONSTANTS.into_iter().filter(|(name, _)| takes(name)) {
        constants[name] = json!(value);
    }
    if takes("C30") {
        constants["C20"] = json!(-0.01);
    }
    if takes("OGDEN_MODULI") {
        constants["OGDEN_MODULI"] = json!([0.6, 0.001, -0.01]);
        constants["OGDEN_EXPONENTS"] = json!([1.3, 5.0, -2.0]);
    }
    if takes("PRONY_SHARES") && !is_rubber {
        constants["PRONY_SHARES"] = json!([0.2, 0.1]);
        constants["PRONY_TIMES"] = json!([0.1, 10.0]);
    }
    if takes("KINEMATIC_PLASTICITY_PARAMETERS") {
        constants["KINEMATIC_HARDENING_TYPE"] = json!(1);
        constants["KINEMATIC_PLASTICITY_PARAMETERS"] = json!([20_000.0, 100.0]);
    }
    constants
}

/// A value within the objects of a dotted path.
fn at(path: &str, value: Value) -> Value {
    path.rsplit('.').fold(value, |inner, key| json!({ key: inner }))
}
