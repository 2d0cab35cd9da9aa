//! Checked settings as plain `serde` structs, with errors at the key that causes them.

use serde::de::DeserializeOwned;
use serde_path_to_error::Segment;

use super::node::Node;
use super::settings::{Settings, place_of};
use crate::diagnostics::{Diagnostic, Result, did_you_mean};

impl Settings {
    /// The settings as a struct; it needs no defaults of its own.
    ///
    /// # Errors
    /// `invalid-value` at the key that does not fit the struct, else at the object.
    pub fn parse<T: DeserializeOwned>(&self) -> Result<T> {
        deserialize(self.node(), self.name())
    }
}

impl Node {
    /// The tree as a value of `T`, called `name` in messages.
    ///
    /// # Errors
    /// `invalid-value` at the key or item that does not fit, else at this node.
    pub fn parse<T: DeserializeOwned>(&self, name: &str) -> Result<T> {
        deserialize(self, name)
    }
}

fn deserialize<T: DeserializeOwned>(node: &Node, name: &str) -> Result<T> {
    serde_path_to_error::deserialize(node.to_json()).map_err(|error| {
        let steps: Vec<String> = error.path().iter().filter_map(step).collect();
        let place = place_of(node, steps.iter().map(String::as_str));
        let what = std::iter::once(name).chain(steps.iter().map(String::as_str)).collect::<Vec<_>>().join(".");
        let text = error.inner().to_string();
        let problem = Diagnostic::error("invalid-value", format!("{what}: {}", text.replace('`', "\""))).at(place);
        match nearest_variant(&text) {
            Some(remedy) => problem.remedy(remedy),
            None => problem,
        }
        .into()
    })
}

fn step(segment: &Segment) -> Option<String> {
    match segment {
        Segment::Seq { index } => Some(index.to_string()),
        Segment::Map { key } => Some(key.clone()),
        Segment::Enum { .. } | Segment::Unknown => None,
    }
}

/// For serde's "unknown variant `a`, expected one of `b`, `c`": which of them is meant.
fn nearest_variant(text: &str) -> Option<String> {
    let rest = text.strip_prefix("unknown variant ").or_else(|| text.strip_prefix("unknown field "))?;
    let mut quoted = rest.split('`').skip(1).step_by(2);
    let wanted = quoted.next()?;
    did_you_mean(wanted, quoted)
}

#[cfg(test)]
mod tests {
    use super::super::{Defaults, Document, Interval, Settings};
    use serde::Deserialize;

    #[derive(Deserialize, Debug)]
    #[serde(rename_all = "snake_case")]
    enum Mode {
        Block,
        Elimination,
    }

    #[derive(Deserialize, Debug)]
    struct Inner {
        depth: usize,
    }

    #[derive(Deserialize, Debug)]
    struct Thing {
        mode: Mode,
        interval: Interval,
        weights: Vec<f64>,
        inner: Inner,
    }

    fn parse(text: &str) -> Result<Thing, String> {
        let text_of_defaults = r#"{"mode": "block", "interval": [0.0, "End"], "weights": [1], "inner": {"depth": 1}}"#;
        let defaults = Defaults::parse("thing", text_of_defaults).unwrap();
        let node = Document::from_str(text, "deck.json").unwrap().root;
        Settings::check(&node, &defaults).and_then(|(s, _)| s.parse()).map_err(|e| e.to_string())
    }

    #[test]
    fn structs_need_no_defaults() {
        let thing = parse("{\"inner\": {\"depth\": 2.0}, \"mode\": \"elimination\"}").unwrap();
        assert!(matches!(thing.mode, Mode::Elimination));
        assert_eq!((thing.inner.depth, thing.weights, thing.interval), (2, vec![1.0], Interval::ALWAYS));
        assert!(matches!(parse("{}").unwrap().mode, Mode::Block));
    }

    #[test]
    fn errors_point_at_the_key() {
        assert_eq!(
            parse("{\n \"mode\": \"blokc\"}").unwrap_err(),
            "error[invalid-value] deck.json:2:2: thing.mode: unknown variant \"blokc\", expected \"block\" or \
             \"elimination\"\n    did you mean \"block\"?"
        );
        let said = parse("{\"inner\":\n  {\"depth\": -1}}").unwrap_err();
        assert!(said.starts_with("error[invalid-value] deck.json:2:4: thing.inner.depth: invalid value"), "{said}");
        let said = parse("{\"weights\": [1,\n \"a\"]}").unwrap_err();
        assert!(said.starts_with("error[invalid-value] deck.json:2:2: thing.weights.1: invalid type"), "{said}");
        let said = parse("{\"interval\": [\"Begin\", 1]}").unwrap_err();
        assert!(said.contains("deck.json:1:2: thing.interval: an interval must be two numbers"), "{said}");
    }
}
