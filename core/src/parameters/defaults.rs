//! Settings of an object: every key with its default, its type and the comment that documents it.

use std::path::Path;

use super::document::{self, Comment};
use super::node::{Member, Node, Value};
use super::range::Range;
use crate::diagnostics::{Diagnostic, Result};

/// The defaults of one object, and how strictly a deck is held against them.
#[derive(Debug, Clone)]
pub struct Defaults {
    pub(super) name: String,
    pub(super) node: Node,
    pub(super) lenient: bool,
    pub(super) required: Vec<&'static str>,
    pub(super) deprecated: Vec<Deprecated>,
    description: String,
    entries: Vec<DefaultEntry>,
    example: Option<Node>,
}

/// One documented key.
#[derive(Debug, Clone, PartialEq)]
pub struct DefaultEntry {
    /// Dotted path of the key from the object's root.
    pub path: String,
    /// Type of the value, e.g. `a number`.
    pub kind: &'static str,
    /// The default as compact JSON.
    pub default: String,
    /// The comment beside or above the key; empty when there is none.
    pub description: String,
    /// Why the key is read and changes nothing, where that is so.
    pub without_effect: Option<String>,
    /// The numbers that it accepts, where they are limited.
    pub range: Option<Range>,
    /// The words that it accepts; any where there are none.
    pub choices: Vec<String>,
    /// Path of the switch without which the key changes nothing.
    pub switch: Option<String>,
}

/// The member of a file of defaults that lists keys without effect by the reason.
const WITHOUT_EFFECT: &str = "$without_effect";

/// The member of a file of defaults that lists keys by the range of their numbers.
const RANGES: &str = "$ranges";

/// The member of a file of defaults that lists keys by the words that they accept.
const CHOICES: &str = "$choices";

/// The member of a file of defaults that lists keys by the switch without which they change nothing.
const SWITCHES: &str = "$switches";

/// The member of a file of defaults that shows how the object is used.
const EXAMPLE: &str = "$example";

/// An old spelling that decks still use.
#[derive(Debug, Clone)]
pub(super) struct Deprecated {
    pub(super) old: &'static str,
    pub(super) what: Replacement,
}

#[derive(Debug, Clone)]
pub(super) enum Replacement {
    Renamed(&'static str),
    Translated(&'static str, fn(&Value) -> Option<Value>),
    Dropped(&'static str),
}

impl Defaults {
    /// Reads the defaults of the object `name` from JSON with comments.
    ///
    /// A default of `null` accepts any value, `{}` any content; the items of arrays are not checked. A number written
    /// without fraction stands for an integer. The comment above a key or at the end of its line documents it, the
    /// one above the opening brace the object. `$without_effect` is no key: it lists those that are read and change nothing,
    /// `{ "reason": ["key", "other.key"] }`. Nor is `$ranges`, which lists keys by the range of their numbers,
    /// `{ "(0, 1]": ["key"] }`, `$choices`, by the words that they accept, `{ "one | other": ["key"] }`, `$switches`, by the switch
    /// without which they change nothing, `{ "switch": ["key"] }`, nor `$example`, settings as a deck may give them.
    ///
    /// # Errors
    /// `invalid-json`, `wrong-type` when the text is not an object, `unknown-key` when a key without effect or with a range is none,
    /// `invalid-value` for a range that is none.
    pub fn parse(name: &str, text: &str) -> Result<Self> {
        let (document, comments) = document::parse(text, Path::new(name), true)?;
        let mut node = document.root;
        let [without_effect, ranges, choices, switches, example] = match &mut node.value {
            Value::Object(members) => {
                [WITHOUT_EFFECT, RANGES, CHOICES, SWITCHES, EXAMPLE].map(|key| members.remove(key))
            }
            _ => [const { None }; 5],
        };
        let example = example.map(|member| member.node);
        node.object()?;
        let mut entries = Vec::new();
        collect(&node, "", &comments, &mut entries);
        if let Some(without_effect) = without_effect {
            for_each_key(&without_effect.node, &mut entries, &mut |reason, entry| {
                entry.without_effect = Some(reason.key.clone());
                Ok(())
            })?;
        }
        if let Some(ranges) = ranges {
            for_each_key(&ranges.node, &mut entries, &mut |range, entry| {
                let problem = || {
                    Diagnostic::error("invalid-value", format!("{:?} is no range; write e.g. [0, inf)", range.key))
                        .at(range.node.place())
                };
                entry.range = Some(Range::parse(&range.key).ok_or_else(problem)?);
                Ok(())
            })?;
        }
        if let Some(choices) = choices {
            for_each_key(&choices.node, &mut entries, &mut |words, entry| {
                entry.choices = words.key.split('|').map(|word| word.trim().to_owned()).collect();
                Ok(())
            })?;
        }
        if let Some(switches) = switches {
            for_each_key(&switches.node, &mut entries, &mut |switch, entry| {
                entry.switch = Some(switch.key.clone());
                Ok(())
            })?;
        }
        let description = comment_above(&comments, node.line);
        let (lenient, required, deprecated) = (false, Vec::new(), Vec::new());
        Ok(Self { name: name.to_owned(), node, lenient, required, deprecated, description, entries, example })
    }

    /// Defaults without any key that accept any content.
    pub fn free_form(name: &str) -> Self {
        let node = Node::new(Value::Object(super::Object::default()), &crate::diagnostics::Place::file(name));
        let (required, deprecated, entries) = (Vec::new(), Vec::new(), Vec::new());
        Self {
            name: name.to_owned(),
            node,
            lenient: false,
            required,
            deprecated,
            description: String::new(),
            entries,
            example: None,
        }
    }

    /// The same defaults where unknown keys are a warning, `unknown-key-ignored`.
    #[must_use]
    pub fn lenient(mut self) -> Self {
        self.lenient = true;
        self
    }

    /// The same defaults where these keys must be given; paths may be dotted.
    #[must_use]
    pub fn require(mut self, keys: &[&'static str]) -> Self {
        self.required.extend_from_slice(keys);
        self
    }

    /// The same defaults, accepting an old spelling with a warning; paths may be dotted.
    #[must_use]
    pub fn renamed(mut self, old: &'static str, new: &'static str) -> Self {
        self.deprecated.push(Deprecated { old, what: Replacement::Renamed(new) });
        self
    }

    /// The same defaults, accepting an old key whose value is translated for the new one (`None`: no such value).
    #[must_use]
    pub fn translated(mut self, old: &'static str, new: &'static str, f: fn(&Value) -> Option<Value>) -> Self {
        self.deprecated.push(Deprecated { old, what: Replacement::Translated(new, f) });
        self
    }

    /// The same defaults, accepting a key that has no effect any more, with a warning that says why.
    #[must_use]
    pub fn dropped(mut self, old: &'static str, why: &'static str) -> Self {
        self.deprecated.push(Deprecated { old, what: Replacement::Dropped(why) });
        self
    }

    /// The name of the object, as messages give it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The comment above the opening brace: a description of the object.
    pub fn description(&self) -> &str {
        &self.description
    }

    /// Every key, nested ones too, in the order written.
    pub fn entries(&self) -> &[DefaultEntry] {
        &self.entries
    }

    /// Old spellings that are accepted with a warning, by dotted path, each with its replacement.
    pub fn old_spellings(&self) -> impl Iterator<Item = (&'static str, String)> {
        self.deprecated.iter().map(|old| match old.what {
            Replacement::Renamed(new) | Replacement::Translated(new, _) => (old.old, format!("old spelling of {new}")),
            Replacement::Dropped(why) => (old.old, format!("without effect: {why}")),
        })
    }

    /// Settings as a deck may give them, where the file shows some.
    pub fn example(&self) -> Option<&Node> {
        self.example.as_ref()
    }

    /// The tree of defaults.
    pub fn node(&self) -> &Node {
        &self.node
    }
}

fn collect(node: &Node, prefix: &str, comments: &[Comment], out: &mut Vec<DefaultEntry>) {
    for member in node.as_object().into_iter().flat_map(|o| o.in_source_order()) {
        let path = if prefix.is_empty() { member.key.clone() } else { format!("{prefix}.{}", member.key) };
        let beside = comments.iter().filter(|c| !c.own_line && c.first_line == end_line(&member.node));
        let mut texts = vec![comment_above(comments, member.key_position.0)];
        texts.extend(beside.map(|c| c.text.clone()));
        texts.retain(|t| !t.is_empty());
        let kind = if member.node.is_null() { "any value" } else { member.node.value.kind() };
        let default = member.node.to_json().to_string();
        out.push(DefaultEntry {
            path: path.clone(),
            kind,
            default,
            description: texts.join("\n"),
            without_effect: None,
            range: None,
            choices: Vec::new(),
            switch: None,
        });
        collect(&member.node, &path, comments, out);
    }
}

/// Visits the keys that an object of lists names, each with the member that it is listed under.
fn for_each_key(
    lists: &Node,
    entries: &mut [DefaultEntry],
    visit: &mut dyn FnMut(&Member, &mut DefaultEntry) -> Result<()>,
) -> Result<()> {
    for list in lists.object()?.iter() {
        for key in list.node.array()? {
            let path = key.str()?;
            let Some(entry) = entries.iter_mut().find(|entry| entry.path == path) else {
                let problem = Diagnostic::error("unknown-key", format!("{path:?} under {:?} is no key", list.key));
                return Err(problem.at(key.place()).into());
            };
            visit(list, entry)?;
        }
    }
    Ok(())
}

/// The line where a comment beside the value stands: that of its last item, for an object that of its brace.
fn end_line(node: &Node) -> u32 {
    match &node.value {
        Value::Array(items) => items.last().map_or(node.line, end_line),
        _ => node.line,
    }
}

/// The comments on lines of their own that end directly above `line`.
fn comment_above(comments: &[Comment], line: u32) -> String {
    let mut texts = Vec::new();
    let mut next = line;
    for comment in comments.iter().rev().filter(|c| c.own_line && c.last_line < line) {
        if comment.last_line + 1 != next {
            break;
        }
        next = comment.first_line;
        texts.insert(0, comment.text.as_str());
    }
    texts.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_document_keys() {
        let text = r#"// Fixes a thing.
// Twice.
{
    // Name of the
    // part.
    "part": "",
    "tolerance": 1e-4, // relative
    "interval": [0.0, "End"], /* when it acts */
    "nested": { // an object

        "count": 3
    },
    "$without_effect": { "everything is counted": ["nested.count"] }
}"#;
        let defaults = Defaults::parse("thing", text).unwrap();
        assert_eq!(defaults.description(), "Fixes a thing.\nTwice.");
        let without_effect =
            defaults.entries().iter().filter_map(|entry| Some((&*entry.path, entry.without_effect.as_deref()?)));
        assert_eq!(without_effect.collect::<Vec<_>>(), [("nested.count", "everything is counted")]);
        assert!(Defaults::parse("thing", r#"{ "a": 1, "$without_effect": { "why": ["b"] } }"#).is_err());
        let ranged = Defaults::parse("thing", r#"{ "a": 1.0, "$ranges": { "(0, inf)": ["a"] } }"#).unwrap();
        assert!(ranged.entries()[0].range.is_some_and(|range| !range.holds(0.0)));
        assert!(Defaults::parse("thing", r#"{ "a": 1, "$ranges": { "above 0": ["a"] } }"#).is_err());
        let text = r#"{ "on": false, "a": "x", "$choices": { "x | y": ["a"] }, "$switches": { "on": ["a"] } }"#;
        let defaults_with_words = Defaults::parse("thing", text).unwrap();
        let entry = &defaults_with_words.entries()[1];
        assert_eq!((entry.choices.join(" "), entry.switch.as_deref()), ("x y".to_owned(), Some("on")));
        let said: Vec<String> = defaults
            .entries()
            .iter()
            .map(|e| format!("{} = {} ({}): {}", e.path, e.default, e.kind, e.description.replace('\n', " ")))
            .collect();
        assert_eq!(
            said,
            [
                "part = \"\" (a string): Name of the part.",
                "tolerance = 0.0001 (a number): relative",
                "interval = [0.0,\"End\"] (an array): when it acts",
                "nested = {\"count\":3} (an object): an object",
                "nested.count = 3 (an integer): ",
            ]
        );
    }

    #[test]
    fn defaults_must_be_an_object() {
        assert!(Defaults::parse("thing", "[]").unwrap_err().to_string().contains("thing:1:1: expected an object"));
    }
}
