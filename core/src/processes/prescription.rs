//! What a process prescribes at a time, asked before anything runs.

use crate::model::ScalarVariable;

/// Values of one unknown that a process fixes.
#[derive(Debug, Clone, PartialEq)]
pub struct Prescription {
    /// The process and its part, for messages.
    pub by: String,
    /// The unknown.
    pub variable: ScalarVariable,
    /// Nodes (index); the value, `None` where the unknown stays as it is.
    pub values: Vec<(u32, Option<f64>)>,
}
