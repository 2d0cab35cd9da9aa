//! The time span in which a process acts.

use serde::de::{Deserialize, Deserializer, Error as _};

use super::node::Node;
use crate::diagnostics::{Diagnostic, Result};

/// The end that `"End"` stands for.
const UNBOUNDED: f64 = 1.0e30;

/// A time span `[begin, end]`, written `[0.0, "End"]` in decks.
///
/// In the unit of TIME. With `begin` = 0 the end point is outside, otherwise inside: the tolerance of both ends is
/// relative to `begin`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// First instant.
    pub begin: f64,
    /// Last instant; 1e30 stands for no end. Before `begin`: the interval holds nothing.
    pub end: f64,
}

impl Interval {
    /// All times from 0.
    pub const ALWAYS: Self = Self { begin: 0.0, end: UNBOUNDED };

    /// Whether a time lies in the interval.
    pub fn contains(&self, time: f64) -> bool {
        let tolerance = (1e-14 * self.begin).max(1e-30);
        self.begin - tolerance < time && time < self.end + tolerance
    }

    /// Reads `[begin, end]`, where the end may be `"End"`.
    ///
    /// # Errors
    /// `invalid-interval` for anything else.
    pub fn from_node(node: &Node) -> Result<Self> {
        Self::from_json(&node.to_json()).ok_or_else(|| {
            let fact = format!("an interval must be two numbers, found {node}");
            Diagnostic::error("invalid-interval", fact).at(node.place()).remedy(REMEDY).into()
        })
    }

    fn from_json(json: &serde_json::Value) -> Option<Self> {
        match json.as_array()?.as_slice() {
            [begin, end] => {
                let end = end.as_f64().or_else(|| (end.as_str()? == "End").then_some(UNBOUNDED))?;
                Some(Self { begin: begin.as_f64()?, end })
            }
            _ => None,
        }
    }
}

const REMEDY: &str = "write e.g. [0.0, 1.0] or [0.0, \"End\"]; only the second entry may be \"End\"";

impl<'de> Deserialize<'de> for Interval {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let json = serde_json::Value::deserialize(deserializer)?;
        let wrong = || D::Error::custom(format!("an interval must be two numbers, found {json}; {REMEDY}"));
        Self::from_json(&json).ok_or_else(wrong)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Document;
    use super::*;

    fn read(text: &str) -> Result<Interval> {
        Interval::from_node(&Document::from_str(text, "deck.json")?.root)
    }

    #[test]
    fn the_end_is_outside_when_the_interval_begins_at_zero() {
        let from_zero = read("[0, 0.2]").unwrap();
        assert!(from_zero.contains(0.0) && from_zero.contains(0.1) && !from_zero.contains(0.2));
        let later = read("[0.2, 0.4]").unwrap();
        assert!(later.contains(0.2) && later.contains(0.4) && later.contains(0.2 - 1e-15));
        assert!(!later.contains(0.2 - 1e-12) && !later.contains(0.4 + 1e-12));
    }

    #[test]
    fn the_end_may_be_a_word() {
        let open = read("[1.0, \"End\"]").unwrap();
        assert!(open.contains(1e29) && !open.contains(0.5));
        assert!(Interval::ALWAYS.contains(0.0));
        let inverted = read("[2.0, 1.0]").unwrap();
        assert!([0.5, 1.0, 1.5, 2.0, 2.5].iter().all(|&t| !inverted.contains(t)));
    }

    #[test]
    fn anything_else_is_refused() {
        assert_eq!(
            read("[\"Begin\", 1.0]").unwrap_err().to_string(),
            "error[invalid-interval] deck.json:1:1: an interval must be two numbers, found [\"Begin\",1.0]\n    \
             write e.g. [0.0, 1.0] or [0.0, \"End\"]; only the second entry may be \"End\""
        );
        for text in ["[0, \"end\"]", "[1]", "1", "[0, 1, 2]", "[0, null]"] {
            assert!(read(text).is_err(), "{text}");
        }
    }
}
