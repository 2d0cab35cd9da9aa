//! `zelus schema`: JSON Schema (2020-12) of decks and materials, of the registry and its defaults, for editors and programs.

use clap::ValueEnum;
use serde_json::{Map, Value, json};
use zelus_core::Result;
use zelus_core::analysis::SolverEntry;
use zelus_core::diagnostics::Place;
use zelus_core::model::{VariableKind, variables};
use zelus_core::parameters::{self, Defaults, Node};
use zelus_core::registry::{self, Entry};

/// Kind of file that a schema describes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Of {
    /// ProjectParameters.json.
    Deck,
    /// The file of materials.
    Materials,
}

/// Outlines of the schemas, to which the registry adds its objects: the file that each describes, and its text.
pub(super) const OUTLINES: [(&str, &str); 2] = [
    ("ProjectParameters.json", include_str!("../../configs/schema/deck.json")),
    ("StructuralMaterials.json", include_str!("../../configs/schema/materials.json")),
];

/// Keys whose value is a registered name, with its kind.
const NAMES: [(&str, &str); 6] = [
    ("scheme_type", "scheme"),
    ("convergence_criterion", "convergence_criterion"),
    ("frictional_law", "friction_law"),
    ("adaptation_rule", "penalty_adaptation"),
    ("file_format", "output_format"),
    ("preconditioner_type", "preconditioner"),
];

/// The schema.
///
/// # Errors
/// Defaults of a registered object that cannot be read.
pub(super) fn schema(of: Of) -> Result<Value> {
    match of {
        Of::Deck => deck(),
        Of::Materials => materials(),
    }
}

fn deck() -> Result<Value> {
    let mut schema = outline(OUTLINES[0].1);
    let definitions = schema["$defs"].as_object_mut().expect("the outline has definitions");
    definitions.insert("variable".to_owned(), variable());
    for kind in ["process", "modeler", "solver", "solver_extension", "strategy", "linear_solver"] {
        for entry in entries(kind).into_iter().filter(|entry| !entry.defaults.is_empty()) {
            definitions.insert(format!("{kind}.{}", entry.name), object(entry)?);
        }
    }
    for solver in registry::all::<SolverEntry>() {
        let adapted = (solver.build.adapt)(Defaults::parse(solver.name, solver.defaults)?);
        let Some(settings) = definitions.get_mut(&format!("solver.{}", solver.name)) else { continue };
        let own = settings["properties"].as_object_mut().expect("an object of settings");
        for (old, instead) in adapted.old_spellings().filter(|(old, _)| !old.contains('.')) {
            own.insert(old.to_owned(), json!({ "deprecated": true, "description": instead }));
        }
    }
    let extensions: Map<String, Value> = entries("solver_extension")
        .iter()
        .map(|entry| (entry.name.to_owned(), reference("solver_extension", entry)))
        .collect();
    for solver in entries("solver") {
        let Some(settings) = definitions.get_mut(&format!("solver.{}", solver.name)) else { continue };
        let own = settings["properties"].as_object_mut().expect("an object of settings");
        for (key, value) in extensions.iter().filter(|(key, _)| !solver.defaults.contains(&format!("\"{key}\""))) {
            own.insert(key.clone(), value.clone());
        }
    }
    let part = |name: &str| json!({ "$ref": format!("#/$defs/{name}") });
    for (_, settings) in definitions.iter_mut().filter(|(name, _)| name.starts_with("solver.")) {
        let own = settings["properties"].as_object_mut().expect("an object of settings");
        for key in ["time_stepping", "model_import_settings", "linear_solver_settings", "solving_strategy_settings"] {
            own.entry(key).and_modify(|value| *value = part(key));
        }
        if let Some(value) = own.get_mut("builder_and_solver_settings") {
            value["properties"]["type"] = named("builder_and_solver", "");
        }
    }
    definitions.insert("solver_settings".to_owned(), solver_settings());
    let mut linear = json!({ "type": "object", "description": "The linear solver; empty for automatic choice." });
    linear["properties"]["solver_type"] = named("linear_solver", "");
    let own = choices("solver_type", "linear_solver", |then| then);
    if !own.is_empty() {
        linear["allOf"] = json!(own);
    }
    definitions.insert("linear_solver_settings".to_owned(), linear);
    let mut strategy = json!({ "type": "object", "description": "How a step is iterated." });
    strategy["properties"] = json!({ "type": named("strategy", ""), "advanced_settings": { "type": "object" } });
    strategy["allOf"] =
        json!(choices("type", "strategy", |then| json!({ "properties": { "advanced_settings": then } })));
    definitions.insert("solving_strategy_settings".to_owned(), strategy);
    let mut formats = all_names("mesh_format");
    formats.extend(["use_input_model_part", "rest"].map(str::to_owned));
    definitions["model_import_settings"]["properties"]["input_type"]["enum"] = json!(formats);
    definitions.insert("process".to_owned(), item("python_module", "process", "Parameters"));
    definitions["modelers"]["items"] = item("name", "modeler", "parameters");
    Ok(schema)
}

fn materials() -> Result<Value> {
    let mut schema = outline(OUTLINES[1].1);
    let definitions = schema["$defs"].as_object_mut().expect("the outline has definitions");
    let law = json!({
        "type": "object",
        "description": "The law, with or without its application before a dot.",
        "properties": { "name": { "anyOf": [{ "enum": all_names("constitutive_law") }, { "pattern": "^.+\\.|Factory$" }] } },
        "required": ["name"]
    });
    definitions.insert("constitutive_law".to_owned(), law);
    let of = |kind: VariableKind| match kind {
        VariableKind::Scalar => json!({ "type": "number" }),
        VariableKind::Integer => json!({ "type": "integer" }),
        VariableKind::Boolean => json!({ "type": "boolean" }),
        VariableKind::Text => json!({ "type": "string" }),
        VariableKind::Vector3 => {
            json!({ "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3 })
        }
        VariableKind::Vector => json!({ "type": "array", "items": { "type": "number" } }),
        VariableKind::Matrix => json!({ "type": "array", "items": { "type": "array", "items": { "type": "number" } } }),
    };
    let mut properties = Map::new();
    for (name, entry) in variables() {
        let mut value = of(entry.kind);
        value["description"] = json!(entry.about);
        properties.insert((*name).to_owned(), value);
    }
    let constants = json!({
        "type": "object",
        "description": "Constants by variable, with or without its application before a dot.",
        "properties": properties,
        "propertyNames": variable()
    });
    definitions.insert("variables".to_owned(), constants);
    Ok(schema)
}

fn outline(text: &str) -> Value {
    serde_json::from_str(text).expect("the outline is JSON")
}

fn entries(kind: &str) -> Vec<&'static Entry> {
    let mut all: Vec<_> =
        registry::entries().into_iter().filter(|(word, _)| *word == kind).map(|(_, entry)| entry).collect();
    all.sort_by_key(|entry| entry.name);
    all
}

/// Names and aliases of a kind.
fn all_names(kind: &str) -> Vec<String> {
    entries(kind).into_iter().flat_map(Entry::names).map(str::to_owned).collect()
}

/// A word that is a registered name, or the default.
fn named(kind: &str, default: &str) -> Value {
    let mut names = all_names(kind);
    let qualified = qualified(&names);
    if !names.iter().any(|name| name == default) {
        names.push(default.to_owned());
    }
    json!({ "anyOf": [{ "enum": names }, qualified] })
}

/// A variable or a component of one, with or without its application before a dot.
fn variable() -> Value {
    let component = |(name, entry): (&&str, &&zelus_core::model::VariableEntry)| match entry.kind {
        VariableKind::Vector3 => ["", "_X", "_Y", "_Z"].map(|end| format!("{name}{end}")).to_vec(),
        _ => vec![(*name).to_owned()],
    };
    let names: Vec<String> = variables().iter().flat_map(component).collect();
    json!({ "anyOf": [{ "enum": names }, { "type": "string", "pattern": "\\." }] })
}

/// One of these names after words that end in a dot: the application that it is of in Kratos.
fn qualified(names: &[String]) -> Value {
    json!({ "type": "string", "pattern": format!("\\.({})$", names.join("|")) })
}

fn reference(kind: &str, entry: &Entry) -> Value {
    json!({ "$ref": format!("#/$defs/{kind}.{}", entry.name) })
}

/// The settings of a registered object.
fn object(entry: &Entry) -> Result<Value> {
    let defaults = Defaults::parse(entry.name, entry.defaults)?;
    let mut settings = of_node(defaults.node(), "", &defaults);
    settings["description"] = json!(entry.about);
    Ok(settings)
}

/// Schema of the values that may replace a default.
fn of_node(node: &Node, path: &str, defaults: &Defaults) -> Value {
    let key = path.rsplit('.').next().unwrap_or(path);
    let mut schema = match &node.value {
        parameters::Value::Null => json!({}),
        parameters::Value::Bool(_) => json!({ "type": "boolean" }),
        parameters::Value::Integer(_) => json!({ "type": "integer" }),
        parameters::Value::Double(_) => json!({ "type": "number" }),
        parameters::Value::String(default) => match NAMES.iter().find(|(name, _)| *name == key) {
            Some((_, kind)) => named(kind, default),
            None if key == "variable_name" => json!({ "$ref": "#/$defs/variable" }),
            None => json!({ "type": "string" }),
        },
        parameters::Value::Array(_) => json!({ "type": "array" }),
        parameters::Value::Object(members) if members.is_empty() => json!({ "type": "object" }),
        parameters::Value::Object(members) => {
            let own = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
            let each = members.in_source_order().iter();
            let properties: Map<String, Value> =
                each.map(|member| (member.key.clone(), of_node(&member.node, &own(&member.key), defaults))).collect();
            json!({ "type": "object", "properties": properties, "additionalProperties": false })
        }
    };
    if let Some(entry) = defaults.entries().iter().find(|entry| entry.path == path) {
        let without_effect = entry.without_effect.as_ref().map(|why| format!("Without effect: {why}."));
        let words: Vec<&str> = [&*entry.description]
            .into_iter()
            .chain(without_effect.as_deref())
            .filter(|text| !text.is_empty())
            .collect();
        if !words.is_empty() {
            schema["description"] = json!(words.join(" "));
        }
        schema["default"] = node.to_json();
        for (keyword, bound) in entry.range.iter().flat_map(parameters::Range::schema) {
            // Limits of a list are those of its items.
            let limited = if schema["type"] == "array" { &mut schema["items"] } else { &mut schema };
            limited[keyword] = json!(bound);
        }
        if !entry.choices.is_empty() {
            schema["enum"] = json!(entry.choices);
        }
        if without_effect.is_some() {
            schema["deprecated"] = json!(true);
        }
    }
    schema
}

/// For each entry of a kind with settings: the schema that holds where `key` names it.
fn choices(key: &str, kind: &str, then: impl Fn(Value) -> Value) -> Vec<Value> {
    let with_settings = entries(kind).into_iter().filter(|entry| !entry.defaults.is_empty());
    let choice = |entry: &'static Entry| json!({ "if": is_called(key, entry), "then": then(reference(kind, entry)) });
    with_settings.map(choice).collect()
}

/// Condition: `key` names the entry, with or without words before a dot.
fn is_called(key: &str, entry: &Entry) -> Value {
    let names = entry.names().collect::<Vec<_>>().join("|");
    json!({ "properties": { key: { "pattern": format!("^(.*\\.)?({names})$") } }, "required": [key] })
}

/// An item of a list of processes or modelers: a name, and the settings of that object.
fn item(key: &str, kind: &str, settings: &str) -> Value {
    let names = all_names(kind);
    let mut properties = json!({ settings: { "type": "object" } });
    for key in [key, "name"] {
        properties[key] = json!({ "anyOf": [{ "enum": names }, qualified(&names)] });
    }
    let either: Vec<Value> = if key == "name" { vec![json!(key)] } else { vec![json!(key), json!("name")] };
    let settings_of = |key: &Value| {
        choices(key.as_str().unwrap_or_default(), kind, |then| json!({ "properties": { settings: then } }))
    };
    let all: Vec<Value> = either.iter().flat_map(settings_of).collect();
    let either: Vec<Value> = either.into_iter().map(|key| json!({ "required": [key] })).collect();
    json!({ "type": "object", "properties": properties, "anyOf": either, "allOf": all })
}

/// The settings of the solver that `solver_type`, and where it is another for explicit steps `time_integration_method`, names.
fn solver_settings() -> Value {
    let names = all_names("solver");
    let explicit = json!({ "properties": { "time_integration_method": { "const": "explicit" } }, "required": ["time_integration_method"] });
    let of_explicit = |solver: &SolverEntry| {
        let asked = json!({ "solver_type": solver.name, "time_integration_method": "explicit" });
        Node::from_json(&asked, &Place::file("a deck")).ok().and_then(|asked| (solver.build.variant)(&asked))
    };
    let choice = |solver: &'static SolverEntry| match of_explicit(solver).and_then(registry::find::<SolverEntry>) {
        Some(other) => json!({
            "if": is_called("solver_type", solver),
            "then": { "if": explicit, "then": reference("solver", other), "else": reference("solver", solver) }
        }),
        None => json!({ "if": is_called("solver_type", solver), "then": reference("solver", solver) }),
    };
    json!({
        "type": "object",
        "description": "How the problem is solved.",
        "properties": { "solver_type": { "enum": names } },
        "required": ["solver_type"],
        "allOf": registry::all::<SolverEntry>().into_iter().map(choice).collect::<Value>()
    })
}
