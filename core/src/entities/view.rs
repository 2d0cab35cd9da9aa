//! What kernels see of the model.

use std::collections::BTreeMap;

use crate::model::{EntityTable, Nodes, ProcessInfo, Properties};

/// Fields and step data at one moment, to read only.
#[derive(Clone, Copy)]
pub struct StepView<'a> {
    /// Nodes with their fields and flags.
    pub nodes: &'a Nodes,
    /// Elements with their data and flags.
    pub elements: &'a EntityTable,
    /// Conditions with their data and flags.
    pub conditions: &'a EntityTable,
    /// Properties by id.
    pub properties: &'a BTreeMap<usize, Properties>,
    /// Time, counters, named values.
    pub info: &'a ProcessInfo,
}
