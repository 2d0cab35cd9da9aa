//! Keys of decks by name: in the settings of every registered object, and in the outlines of decks and materials.

use serde_json::Value;
use zelus_core::Result;
use zelus_core::parameters::{DefaultEntry, Defaults};
use zelus_core::registry;

use super::schema::OUTLINES;

/// A table of a text file, which decks give in place of a number: kind, name and settings.
const TABLE: (&str, &str, &str) = ("table", "csv_table", include_str!("../../configs/csv_table.json"));

/// A key under one path and with one meaning, and the objects that have it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Key {
    /// Dotted path from the root of the object's settings.
    pub path: String,
    /// Type, default, limits and description, a line each.
    pub lines: Vec<String>,
    /// The objects: the word of their kind, and their name.
    pub of: Vec<[String; 2]>,
}

impl Key {
    /// Whether `name` is the path or its end.
    pub fn is_called(&self, name: &str) -> bool {
        self.path.strip_suffix(name).is_some_and(|before| before.is_empty() || before.ends_with('.'))
    }

    /// The objects in words, those of a kind together.
    pub fn objects(&self) -> String {
        let names = |of_kind: &[[String; 2]]| {
            let names: Vec<&str> = of_kind.iter().map(|[_, name]| name.as_str()).collect();
            format!("{} {}", of_kind[0][0], names.join(", "))
        };
        self.of.chunk_by(|[kind, _], [other, _]| kind == other).map(names).collect::<Vec<_>>().join(", ")
    }
}

/// The keys of all objects, those of one path and meaning together.
///
/// # Errors
/// Defaults of a registered object that cannot be read.
pub(super) fn keys() -> Result<Vec<Key>> {
    let mut all: Vec<Key> = Vec::new();
    let mut add = |path: String, lines: Vec<String>, of: [&str; 2]| match all
        .iter_mut()
        .find(|key| key.path == path && key.lines == lines)
    {
        Some(key) => key.of.push(of.map(str::to_owned)),
        None => all.push(Key { path, lines, of: vec![of.map(str::to_owned)] }),
    };
    let registered = registry::entries().into_iter().map(|(kind, entry)| (kind, entry.name, entry.defaults));
    for (kind, name, text) in registered.chain([TABLE]).filter(|(.., text)| !text.is_empty()) {
        let defaults = Defaults::parse(name, text)?;
        for key in defaults.entries() {
            add(key.path.clone(), lines_of(key, defaults.entries()), [kind, name]);
        }
    }
    for (file, text) in OUTLINES {
        let outline: Value = serde_json::from_str(text).expect("the outline is JSON");
        for (part, schema) in outline["$defs"].as_object().into_iter().flatten() {
            // A stage is the root of a deck; other parts are named after their key.
            let root = if part.starts_with("stage") { "" } else { part };
            outlined(schema, root, &mut |path, schema| add(path.to_owned(), outlined_lines(schema), ["file", file]));
        }
    }
    Ok(all)
}

/// Type, default and limits of a key, and its description.
fn lines_of(key: &DefaultEntry, all: &[DefaultEntry]) -> Vec<String> {
    let within = |other: &&DefaultEntry| {
        let rest = other.path.strip_prefix(&key.path).and_then(|rest| rest.strip_prefix('.'));
        rest.is_some_and(|rest| !rest.contains('.'))
    };
    let inner: Vec<&str> = all.iter().filter(within).filter_map(|other| other.path.rsplit('.').next()).collect();
    let mut value = match inner.is_empty() {
        true => format!("{}, by default {}", key.kind, key.default),
        false => format!("{} with the keys {}", key.kind, inner.join(", ")),
    };
    if let Some(range) = &key.range {
        value.push_str(&format!("; {range}"));
    }
    if !key.choices.is_empty() {
        value.push_str(&format!("; one of {}", key.choices.join(", ")));
    }
    let description = (!key.description.is_empty()).then(|| key.description.replace('\n', " "));
    let switch = key.switch.as_ref().map(|switch| format!("without effect unless {switch} is true"));
    let without_effect = key.without_effect.as_ref().map(|why| format!("without effect: {why}"));
    [Some(value), description, switch, without_effect].into_iter().flatten().collect()
}

/// Visits the keys of an outline, nested ones too, with their paths.
fn outlined(schema: &Value, path: &str, visit: &mut dyn FnMut(&str, &Value)) {
    for (key, inner) in schema["properties"].as_object().into_iter().flatten() {
        let own = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        visit(&own, inner);
        outlined(inner, &own, visit);
    }
}

/// Type, default and description of a key of an outline.
fn outlined_lines(schema: &Value) -> Vec<String> {
    let words = |value: &Value| match value {
        Value::Array(several) => {
            several.iter().map(|one| one.as_str().unwrap_or_default()).collect::<Vec<_>>().join(", ")
        }
        one => one.as_str().unwrap_or_default().to_owned(),
    };
    let mut value = match (&schema["enum"], &schema["type"]) {
        (Value::Null, Value::Null) => String::new(),
        (Value::Null, kind) => words(kind),
        (several, _) => format!("one of {}", words(several)),
    };
    if !schema["default"].is_null() {
        value.push_str(&format!(", by default {}", schema["default"]));
    }
    let lines = [value, schema["description"].as_str().unwrap_or_default().to_owned()];
    lines.into_iter().filter(|line| !line.is_empty()).collect()
}
