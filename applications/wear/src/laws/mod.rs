//! The laws of wear.

mod archard;
