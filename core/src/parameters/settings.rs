//! One object's settings: the user's node merged with the defaults, strictly.

use super::defaults::Defaults;
use super::merge::Merger;
use super::node::{Node, Value};
use crate::diagnostics::{Diagnostic, Place, Report, Result, did_you_mean};

/// The checked settings of one object, complete with defaults.
///
/// ```
/// use zelus_core::parameters::{Defaults, Document, Settings};
///
/// let defaults = Defaults::parse("spring_process", r#"{ "stiffness": 1.0, "steps": 10 }"#)?;
/// let given = Document::from_str(r#"{ "stiffness": 250 }"#, "deck.json")?.root;
/// let (settings, _warnings) = Settings::check(&given, &defaults)?;
/// assert_eq!((settings.get_f64("stiffness")?, settings.get_usize("steps")?), (250.0, 10));
///
/// let misspelt = Document::from_str(r#"{ "stifness": 250 }"#, "deck.json")?.root;
/// let error = Settings::check(&misspelt, &defaults).unwrap_err().to_string();
/// assert!(error.contains("deck.json:1:3") && error.contains("did you mean \"stiffness\"?"));
/// # Ok::<(), zelus_core::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Settings {
    name: String,
    node: Node,
}

impl Settings {
    /// Lays `user` over `defaults`; every key and type that does not fit goes to `report`.
    ///
    /// `None` when an error was reported. Unknown keys are errors (`unknown-key`), or warnings with
    /// [`Defaults::lenient`] (`unknown-key-ignored`); other codes are `wrong-type`, `missing-key`, `out-of-range` and, as warnings,
    /// `deprecated-key` and `key-without-effect`.
    pub fn validate(user: &Node, defaults: &Defaults, report: &mut Report) -> Option<Self> {
        Self::complete(user, defaults, report).and_then(|(settings, is_sound)| is_sound.then_some(settings))
    }

    /// As [`Settings::validate`], where defaults replace unsuitable values; also returns whether all values are suitable.
    ///
    /// `None` when the settings are no object.
    pub fn complete(user: &Node, defaults: &Defaults, report: &mut Report) -> Option<(Self, bool)> {
        let mut user = user.clone();
        if user.as_object().is_none() {
            let fact = format!("the settings of {} must be an object, found {}", defaults.name, user.value.kind());
            report.push(Diagnostic::error("wrong-type", fact).at(user.place()).remedy("write { ... }"));
            return None;
        }
        let mut merger = Merger { lenient: defaults.lenient, report, failed: false };
        for old in &defaults.deprecated {
            merger.translate(&mut user, old, &defaults.name);
        }
        for path in &defaults.required {
            if user.get_path(path).is_none() {
                let fact = format!("\"{path}\" of {} must be given", defaults.name);
                let remedy = format!("add \"{path}\"");
                merger.error(Diagnostic::error("missing-key", fact).at(user.place()).remedy(remedy));
            }
        }
        let node = merger.merge(&user, &defaults.node, &defaults.name);
        for entry in defaults.entries() {
            let given = node.get_path(&entry.path).filter(|given| given.is_given());
            let Some(given) = given else { continue };
            let word =
                given.as_str().filter(|word| !entry.choices.is_empty() && !entry.choices.iter().any(|w| w == word));
            if let Some(word) = word {
                let fact = format!("\"{}\" of {} is {word:?}", entry.path, defaults.name);
                let near = did_you_mean(word, entry.choices.iter().map(String::as_str));
                let remedy = near.unwrap_or_else(|| format!("write one of {}", entry.choices.join(", ")));
                merger.error(Diagnostic::error("invalid-value", fact).at(given.place()).remedy(remedy));
            }
            let Some(range) = entry.range else { continue };
            if let Some(problem) = range.problem(given, &format!("\"{}\" of {}", entry.path, defaults.name)) {
                merger.error(problem.remedy(format!("{} is the default", entry.default)));
            }
        }
        let is_sound = !merger.failed;
        if is_sound {
            warn_without_effect(&user, &node, defaults, report);
        }
        Some((Self { name: defaults.name.clone(), node }, is_sound))
    }

    /// [`Settings::validate`] for one object alone, with its warnings.
    ///
    /// # Errors
    /// Every problem found, as [`crate::diagnostics::Error::Input`].
    pub fn check(user: &Node, defaults: &Defaults) -> Result<(Self, Vec<Diagnostic>)> {
        let mut report = Report::new();
        let settings = Self::validate(user, defaults, &mut report);
        let warnings = report.finish()?;
        let gone = || Diagnostic::error("invalid-settings", format!("{} cannot be set so", defaults.name));
        Ok((settings.ok_or_else(gone)?, warnings))
    }

    /// The defaults alone, for an object that the deck does not set; `place` is where it is named.
    pub fn defaults(defaults: &Defaults, place: &Place) -> Self {
        let mut node = defaults.node.clone();
        let at = Node::new(Value::Null, place);
        node.move_to((&at.file, at.line, at.column), false);
        Self { name: defaults.name.clone(), node }
    }

    /// Settings that need no check, e.g. an item of a free-form list.
    pub fn unchecked(name: impl Into<String>, node: Node) -> Self {
        Self { name: name.into(), node }
    }

    /// The name of the object, as messages give it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The complete tree.
    pub fn node(&self) -> &Node {
        &self.node
    }

    /// Where the object is written.
    pub fn place(&self) -> Place {
        self.node.place()
    }

    /// Where a key is written, else where the object is; paths may be dotted.
    pub fn key_place(&self, path: &str) -> Place {
        place_of(&self.node, path.split('.'))
    }

    /// The value of a key; paths may be dotted.
    ///
    /// # Errors
    /// `missing-key` when neither the deck nor the defaults have it.
    pub fn get(&self, path: &str) -> Result<&Node> {
        self.node.get_path(path).ok_or_else(|| {
            let fact = format!("\"{path}\" of {} is missing", self.name);
            Diagnostic::error("missing-key", fact).at(self.place()).remedy(format!("add \"{path}\"")).into()
        })
    }

    /// Whether the deck gives the key, rather than the defaults.
    pub fn is_given(&self, path: &str) -> bool {
        self.node.get_path(path).is_some_and(Node::is_given)
    }

    /// A number; errors as [`Settings::get`] and `wrong-type`, as for all typed getters.
    pub fn get_f64(&self, path: &str) -> Result<f64> {
        self.get(path)?.f64()
    }

    /// A number above zero; `invalid-value` for others.
    pub fn get_positive(&self, path: &str) -> Result<f64> {
        let value = self.get_f64(path)?;
        if value > 0.0 && value.is_finite() {
            return Ok(value);
        }
        let fact = format!("\"{path}\" is {value}");
        Err(self.error(path, "invalid-value", fact).remedy("write a number above 0").into())
    }

    /// An integer.
    pub fn get_i64(&self, path: &str) -> Result<i64> {
        self.get(path)?.i64()
    }

    /// An integer from 0.
    pub fn get_usize(&self, path: &str) -> Result<usize> {
        self.get(path)?.usize()
    }

    /// A boolean.
    pub fn get_bool(&self, path: &str) -> Result<bool> {
        self.get(path)?.bool()
    }

    /// A string.
    pub fn get_str(&self, path: &str) -> Result<&str> {
        self.get(path)?.str()
    }

    /// The items of an array.
    pub fn items(&self, path: &str) -> Result<&[Node]> {
        self.get(path)?.array()
    }

    /// The strings of an array.
    pub fn get_strings(&self, path: &str) -> Result<Vec<String>> {
        self.items(path)?.iter().map(|n| n.str().map(str::to_owned)).collect()
    }

    /// The settings of a nested object.
    pub fn sub(&self, path: &str) -> Result<Settings> {
        let node = self.get(path)?;
        node.object()?;
        Ok(Self { name: format!("{}.{path}", self.name), node: node.clone() })
    }

    /// An error at a key: `fact` should name value and key, the object's name is added.
    pub fn error(&self, path: &str, code: &'static str, fact: impl std::fmt::Display) -> Diagnostic {
        Diagnostic::error(code, format!("{fact} (in {})", self.name)).at(self.key_place(path))
    }
}

/// Names keys of `user` that change nothing, wholly or while a switch of the `complete` settings is off, and are not at their default.
fn warn_without_effect(user: &Node, complete: &Node, defaults: &Defaults, report: &mut Report) {
    for entry in defaults.entries() {
        let is_off = |switch: &&String| complete.get_path(switch).and_then(Node::as_bool) == Some(false);
        let switch = entry.switch.as_ref().filter(is_off);
        if entry.without_effect.is_none() && switch.is_none() {
            continue;
        }
        // An object may be given in part: its other keys are at their defaults.
        let given = complete.get_path(&entry.path).filter(|_| user.get_path(&entry.path).is_some());
        let (Some(given), Some(default)) = (given, defaults.node.get_path(&entry.path)) else { continue };
        let same = match (given.as_f64(), default.as_f64()) {
            (Some(given), Some(default)) => given == default,
            _ => given.to_json() == default.to_json(),
        };
        if !same {
            let key = format!("\"{}\" of {}", entry.path, defaults.name);
            let (fact, remedy) = match (switch, &entry.without_effect) {
                (Some(switch), _) => (
                    format!("{key} changes nothing: \"{switch}\" is false"),
                    format!("set \"{switch}\" to true, or take the key out"),
                ),
                (None, why) => (format!("{key} is read and changes nothing"), why.clone().unwrap_or_default()),
            };
            report.push(Diagnostic::warning("key-without-effect", fact).at(given.place()).remedy(remedy));
        }
    }
}

/// The place of the deepest node that exists on the way down `path`.
pub(super) fn place_of<'a>(root: &Node, path: impl IntoIterator<Item = &'a str>) -> Place {
    let (mut node, mut place) = (root, root.place());
    for step in path {
        let next = match &node.value {
            Value::Object(object) => object.get(step).map(|n| (n, node.key_place(step))),
            Value::Array(items) => step.parse().ok().and_then(|i: usize| items.get(i)).map(|n| (n, n.place())),
            _ => None,
        };
        match next {
            Some(found) => (node, place) = found,
            None => break,
        }
    }
    place
}

#[cfg(test)]
mod tests {
    use super::super::Document;
    use super::*;

    const DEFAULTS: &str = r#"{
        "name": "x", "count": 3, "tolerance": 1e-4, "active": true, "anything": null, "free": {},
        "list": [1, 2], "inner": { "depth": 1, "path": "" }
    }"#;

    fn node(text: &str) -> Node {
        Document::from_str(text, "deck.json").unwrap().root
    }

    fn defaults() -> Defaults {
        Defaults::parse("solver_settings", DEFAULTS).unwrap()
    }

    fn checked(text: &str, defaults: &Defaults) -> (Option<Settings>, String) {
        let mut report = Report::new();
        let settings = Settings::validate(&node(text), defaults, &mut report);
        assert_eq!(settings.is_none(), report.has_errors());
        (settings, report.diagnostics().iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))
    }

    #[test]
    fn the_user_wins_and_defaults_complete() {
        let text = "{\"count\": 4.0, \"tolerance\": 1,\n \"inner\": {\n\"depth\": 2}, \"free\": {\"q\": [1]}, \"anything\": [3]}";
        let settings = checked(text, &defaults()).0.unwrap();
        assert_eq!(
            settings.node().to_json().to_string(),
            r#"{"active":true,"anything":[3],"count":4,"free":{"q":[1]},"inner":{"depth":2,"path":""},"list":[1,2],"name":"x","tolerance":1.0}"#
        );
        assert!(settings.is_given("inner.depth") && !settings.is_given("inner.path") && !settings.is_given("name"));
        assert_eq!(settings.key_place("inner.depth").to_string(), "deck.json:3:1");
        assert_eq!(settings.key_place("inner.path").to_string(), "deck.json:2:11");
        assert_eq!(settings.key_place("name").to_string(), "deck.json:1:1");
        assert_eq!(settings.get_usize("inner.depth").unwrap(), 2);
        assert_eq!(settings.sub("inner").unwrap().get_str("path").unwrap(), "");
        assert_eq!(settings.get_f64("tolerance").unwrap(), 1.0);
    }

    #[test]
    fn unknown_keys_are_errors_that_help() {
        let said = checked("{\"cuont\": 4,\n \"inner\": {\"_x\": 1}, \"mesh_id\": 0}", &defaults()).1;
        assert_eq!(
            said,
            "error[unknown-key] deck.json:1:2: \"cuont\" is not a setting of solver_settings\n    \
             did you mean \"count\"? known keys: active, anything, count, free, inner, list, name, tolerance\n\
             error[unknown-key] deck.json:2:12: \"_x\" is not a setting of solver_settings.inner\n    \
             known keys: depth, path\n\
             error[unknown-key] deck.json:2:22: \"mesh_id\" is not a setting of solver_settings\n    \
             known keys: active, anything, count, free, inner, list, name, tolerance"
        );
    }

    #[test]
    fn lenient_objects_ignore_unknown_keys_aloud() {
        let (settings, said) = checked("{\"cuont\": 4}", &defaults().lenient());
        assert!(settings.unwrap().get("cuont").is_err());
        assert!(said.starts_with(
            "warning[unknown-key-ignored] deck.json:1:2: \"cuont\" is not a setting of solver_settings and is"
        ));
    }

    #[test]
    fn wrong_types_are_errors() {
        let said = checked("{\"count\": 2.5}", &defaults()).1;
        assert_eq!(
            said,
            "error[wrong-type] deck.json:1:11: solver_settings.count must be an integer, found a number (2.5)\n    \
             write a value like its default, 3"
        );
        for text in [
            "{\"tolerance\": true}",
            "{\"tolerance\": \"1\"}",
            "{\"active\": 1}",
            "{\"name\": 3}",
            "{\"list\": 1}",
            "{\"inner\": []}",
            "{\"free\": 1}",
            "{\"name\": null}",
            "[]",
            "{\"inner\": {\"depth\": \"a\"}}",
        ] {
            assert!(checked(text, &defaults()).1.starts_with("error[wrong-type] deck.json:1:"), "{text}");
        }
        assert_eq!(checked("{\"list\": [\"a\", null, {\"b\": 1}]}", &defaults()).1, "");
    }

    #[test]
    fn old_spellings_are_translated_with_a_warning() {
        let defaults = defaults().renamed("size", "inner.depth").dropped("inner.colour", "there is none").translated(
            "quiet",
            "active",
            |v| if let Value::Bool(b) = v { Some(Value::Bool(!b)) } else { None },
        );
        let (settings, said) = checked("{\"size\": 7, \"inner\": {\"colour\": 3}, \"quiet\": true}", &defaults);
        let settings = settings.unwrap();
        assert_eq!(settings.get_i64("inner.depth").unwrap(), 7);
        assert!(!settings.get_bool("active").unwrap());
        assert_eq!(
            said,
            "warning[deprecated-key] deck.json:1:2: \"size\" of solver_settings is now \"inner.depth\"\n    \
             write \"inner.depth\": 7\n\
             warning[deprecated-key] deck.json:1:23: \"inner.colour\" of solver_settings has no effect: there is none\n    \
             remove \"colour\"\n\
             warning[deprecated-key] deck.json:1:37: \"quiet\" of solver_settings is now \"active\"\n    \
             write \"active\": false"
        );
        let (settings, said) = checked("{\"size\": 7, \"inner\": {\"depth\": 5}}", &defaults);
        assert_eq!(settings.unwrap().get_i64("inner.depth").unwrap(), 5);
        assert!(said.contains("\"size\" of solver_settings is ignored"));
        assert_eq!(checked("{\"size\": 7}", &defaults).0.unwrap().get_i64("inner.depth").unwrap(), 7);
        assert!(checked("{\"quiet\": 7}", &defaults).1.starts_with("error[wrong-type] deck.json:1:2: \"quiet\" of"));
    }

    #[test]
    fn required_keys_must_be_given() {
        let said = checked("\n {}", &defaults().require(&["name"])).1;
        assert_eq!(
            said,
            "error[missing-key] deck.json:2:2: \"name\" of solver_settings must be given\n    add \"name\""
        );
    }

    #[test]
    fn defaults_alone_carry_the_place_of_the_user() {
        let settings = Settings::defaults(&defaults(), &Place::at("deck.json", 9, 4));
        assert_eq!(settings.key_place("inner.depth").to_string(), "deck.json:9:4");
        assert!(!settings.is_given("name"));
    }
}
