//! Functions of space and time as decks write them: `"1.0*(t-2.0)/8.0"`.
//!
//! Variables `x y z` (current position), `X Y Z` (initial position) and `t` (TIME); constants `pi` and `e`; operators `+ - * / % ^`
//! with `**` for `^`; functions of one or two arguments; `A if LEFT < RIGHT else B`. Three rules differ from other languages, and decks
//! rely on them: a sign binds tighter than `^` (`-t^2` is `(-t)^2`), `^` groups from the left (`2^3^2` is 64), and `log` is the decadic
//! logarithm (`ln` the natural one). Of a comma-separated list the last value counts.

mod functions;
mod parser;

use std::fmt;

use crate::diagnostics::{Diagnostic, Place, Result};

use super::node::Node;

/// A compiled function of space and time.
///
/// Evaluation allocates nothing; a result that is not finite is handed on as it is.
#[derive(Clone)]
pub struct Expression {
    text: String,
    code: Vec<Op>,
}

/// Where and when an expression is evaluated.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SpaceTime {
    /// `x y z`: the current position.
    pub current: [f64; 3],
    /// `X Y Z`: the initial position.
    pub initial: [f64; 3],
    /// `t`: the time.
    pub time: f64,
}

/// Why a text is not an expression.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExpressionError {
    /// Character of the text, from 1.
    pub column: u32,
    /// The fact.
    pub fact: String,
    /// The remedy.
    pub remedy: Option<String>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum ExpressionVariable {
    Current(usize),
    Initial(usize),
    Time,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    Power,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
}

/// One step of the stack machine.
#[derive(Debug, Clone, Copy)]
enum Op {
    Push(f64),
    Load(ExpressionVariable),
    Negate,
    Binary(Operator),
    One(fn(f64) -> f64),
    Two(fn(f64, f64) -> f64),
    /// Takes a truth value and skips so many steps when it is 0.
    SkipUnless(usize),
    /// Skips so many steps.
    Skip(usize),
}

/// Values an expression may hold at once; the parser refuses longer ones.
const STACK: usize = 64;

impl Expression {
    /// Compiles a text.
    ///
    /// # Errors
    /// With the character where the text is not an expression; unknown names come with the nearest known one.
    pub fn parse(text: &str) -> Result<Self, ExpressionError> {
        Ok(Self { text: text.to_owned(), code: parser::compile(text)? })
    }

    /// The expression that a string holds, or the constant that a number is.
    ///
    /// # Errors
    /// `wrong-type` for other nodes; `invalid-expression` at the character of the string.
    pub fn from_node(node: &Node) -> Result<Self> {
        if let Some(number) = node.as_f64() {
            return Ok(Self { text: node.to_string(), code: vec![Op::Push(number)] });
        }
        let text = node.str()?;
        Self::parse(text).map_err(|e| {
            let start = node.place();
            let place = Place { column: start.column + e.column, ..start };
            let problem =
                Diagnostic::error("invalid-expression", format!("in \"{}\": {}", excerpt(text, e.column), e.fact))
                    .at(place);
            problem.remedy(e.remedy.unwrap_or_else(|| "write e.g. \"2.0*t + sin(pi*X)\"".into())).into()
        })
    }

    /// The value at a place and time.
    pub fn value(&self, at: &SpaceTime) -> f64 {
        let mut stack = [0.0; STACK];
        let mut top = 0;
        let mut next = 0;
        while let Some(op) = self.code.get(next) {
            next += 1;
            match *op {
                Op::Push(x) => {
                    stack[top] = x;
                    top += 1;
                }
                Op::Load(variable) => {
                    stack[top] = at.get(variable);
                    top += 1;
                }
                Op::Negate => stack[top - 1] = -stack[top - 1],
                Op::One(f) => stack[top - 1] = f(stack[top - 1]),
                Op::Two(f) => {
                    top -= 1;
                    stack[top - 1] = f(stack[top - 1], stack[top]);
                }
                Op::Binary(operator) => {
                    top -= 1;
                    stack[top - 1] = operator.apply(stack[top - 1], stack[top]);
                }
                Op::SkipUnless(steps) => {
                    top -= 1;
                    if stack[top] == 0.0 {
                        next += steps;
                    }
                }
                Op::Skip(steps) => next += steps,
            }
        }
        stack[0]
    }

    /// The text it was compiled from.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether the value depends on the position.
    pub fn uses_space(&self) -> bool {
        self.code
            .iter()
            .any(|op| matches!(op, Op::Load(ExpressionVariable::Current(_) | ExpressionVariable::Initial(_))))
    }

    /// Whether the value depends on the time.
    pub fn uses_time(&self) -> bool {
        self.code.iter().any(|op| matches!(op, Op::Load(ExpressionVariable::Time)))
    }
}

impl SpaceTime {
    fn get(&self, variable: ExpressionVariable) -> f64 {
        match variable {
            ExpressionVariable::Current(i) => self.current[i],
            ExpressionVariable::Initial(i) => self.initial[i],
            ExpressionVariable::Time => self.time,
        }
    }
}

impl Operator {
    fn apply(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide => a / b,
            Self::Remainder => a % b,
            Self::Power => a.powf(b),
            Self::Less => f64::from(a < b),
            Self::LessEqual => f64::from(a <= b),
            Self::Greater => f64::from(a > b),
            Self::GreaterEqual => f64::from(a >= b),
            Self::Equal => f64::from(a == b),
        }
    }
}

impl fmt::Debug for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Expression({:?})", self.text)
    }
}

impl fmt::Display for ExpressionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "character {}: {}", self.column, self.fact)?;
        match &self.remedy {
            Some(remedy) => write!(f, "; {remedy}"),
            None => Ok(()),
        }
    }
}

impl<'de> serde::Deserialize<'de> for Expression {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        Self::parse(&text).map_err(serde::de::Error::custom)
    }
}

/// Excerpt of a long text around a column, which counts from 1.
fn excerpt(text: &str, column: u32) -> String {
    const REACH: usize = 60;
    let [length, at] = [text.chars().count(), column as usize - 1];
    if length <= 2 * REACH {
        return text.to_owned();
    }
    let (begin, end) = (at.saturating_sub(REACH), (at + REACH).min(length));
    let within: String = text.chars().skip(begin).take(end - begin).collect();
    format!("{}{within}{}", if begin > 0 { "…" } else { "" }, if end < length { "…" } else { "" })
}

#[cfg(test)]
mod tests;
