//! Ranges of numbers that a key accepts, stated once beside its default.

use std::fmt;

use super::node::{Node, Value};
use crate::diagnostics::Diagnostic;

/// An interval of numbers.
///
/// Files of defaults write it as in a textbook: `[0, inf)` are numbers that are not negative, `(0, 1]` those above 0 and at most 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    low: Bound,
    high: Bound,
}

/// An end of an interval; infinite where there is none.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bound {
    value: f64,
    included: bool,
}

impl Range {
    /// The interval of a text such as `(0, 1]`.
    pub fn parse(text: &str) -> Option<Self> {
        let included = |bracket: char| match bracket {
            '[' | ']' => Some(true),
            '(' | ')' => Some(false),
            _ => None,
        };
        let inner = text.strip_prefix(['[', '('])?.strip_suffix([']', ')'])?;
        let (low, high) = inner.split_once(',')?;
        let end = |text: &str, bracket: char| {
            let value: f64 = text.trim().parse().ok().filter(|value: &f64| !value.is_nan())?;
            Some(Bound { value, included: included(bracket)? })
        };
        let range = Self { low: end(low, text.chars().next()?)?, high: end(high, text.chars().last()?)? };
        (range.low.value < range.high.value).then_some(range)
    }

    /// Whether a number lies in the interval; none that is no number does.
    pub fn holds(&self, number: f64) -> bool {
        let (low, high) = (self.low, self.high);
        let above = if low.included { number >= low.value } else { number > low.value };
        let below = if high.included { number <= high.value } else { number < high.value };
        above && below
    }

    /// The keywords of JSON Schema for the interval.
    pub fn schema(&self) -> Vec<(&'static str, f64)> {
        let low = if self.low.included { "minimum" } else { "exclusiveMinimum" };
        let high = if self.high.included { "maximum" } else { "exclusiveMaximum" };
        let ends = [(low, self.low.value), (high, self.high.value)];
        ends.into_iter().filter(|(_, value)| value.is_finite()).collect()
    }

    /// The first number in a value, alone or in lists, that lies outside the interval: `out-of-range`, with its place. Other
    /// values have no numbers.
    pub fn problem(&self, value: &Node, name: &str) -> Option<Diagnostic> {
        match &value.value {
            Value::Array(items) => items.iter().find_map(|item| self.problem(item, name)),
            Value::Integer(_) | Value::Double(_) if !value.as_f64().is_some_and(|number| self.holds(number)) => {
                let fact = format!("{name} is {value}, it must be {self}");
                Some(Diagnostic::error("out-of-range", fact).at(value.place()))
            }
            _ => None,
        }
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let low = if self.low.included { "at least" } else { "above" };
        let high = if self.high.included { "at most" } else { "below" };
        match (self.low.value.is_finite(), self.high.value.is_finite()) {
            (true, true) => write!(f, "{low} {} and {high} {}", self.low.value, self.high.value),
            (true, false) => write!(f, "{low} {}", self.low.value),
            (false, true) => write!(f, "{high} {}", self.high.value),
            (false, false) => write!(f, "a finite number"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_belong_to_the_interval_where_brackets_say_so() {
        let range = Range::parse("(0, 1]").unwrap();
        assert_eq!(range.to_string(), "above 0 and at most 1");
        assert_eq!(range.schema(), [("exclusiveMinimum", 0.0), ("maximum", 1.0)]);
        let inside = [0.0, 1e-300, 0.5, 1.0, 1.1, f64::NAN, -1.0].map(|number| range.holds(number));
        assert_eq!(inside, [false, true, true, true, false, false, false]);
        let open = Range::parse("[0, inf)").unwrap();
        assert_eq!(open.to_string(), "at least 0");
        assert!(open.holds(0.0) && open.holds(1e300) && !open.holds(f64::INFINITY) && !open.holds(-1e-300));
        assert_eq!(Range::parse("(-inf, 2)").unwrap().to_string(), "below 2");
    }

    #[test]
    fn what_is_no_interval_is_none() {
        for text in ["", "0, 1", "[0, 1", "[1, 0]", "[a, 1]", "[0; 1]", "[0, nan]"] {
            assert_eq!(Range::parse(text), None, "{text}");
        }
    }
}
