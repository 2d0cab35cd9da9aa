//! Settings as the deck writes them: JSON with positions, checked against defaults, and functions of space and time.
//!
//! A [`Document`] is a parsed file whose every [`Node`] knows its place. A registered object states its [`Defaults`]
//! (a JSON text that documents each key); [`Settings::validate`] merges the user's node with them, reports every key or
//! type that does not fit, and hands out typed values, key by key or as one `serde` struct. [`Interval`] and
//! [`Expression`] are kinds of value that decks use in many places.

mod node;
mod document;
mod range;
mod defaults;
mod merge;
mod settings;
mod typed;
mod interval;
mod expression;

pub use defaults::{DefaultEntry, Defaults};
pub use document::Document;
pub use expression::{Expression, ExpressionError, SpaceTime};
pub use interval::Interval;
pub use node::{Member, Node, Object, Value};
pub use range::Range;
pub use settings::Settings;
