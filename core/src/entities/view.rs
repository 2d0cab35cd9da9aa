//! The model as kernels see it.

use std::collections::BTreeMap;

use crate::model::{EntityTable, ModelPart, Nodes, ProcessInfo, Properties, SlaveNodes, StepMark};

/// Mark of iterations in which the history of elements stays as it is: none yields or is damaged further.
pub const ELASTIC: StepMark = StepMark::new("ELASTIC");

/// Fields and step data at one moment, to read only.
#[derive(Clone, Copy)]
pub struct StepView<'a> {
    /// Nodes with their fields and flags.
    pub nodes: &'a Nodes,
    /// Slave nodes with their fields.
    pub slave_nodes: &'a SlaveNodes,
    /// Elements with their data and flags.
    pub elements: &'a EntityTable,
    /// Conditions with their data and flags.
    pub conditions: &'a EntityTable,
    /// Properties by id.
    pub properties: &'a BTreeMap<usize, Properties>,
    /// Time, counters, named values.
    pub info: &'a ProcessInfo,
}

impl ModelPart {
    /// The view of kernels: fields and step data, never the model.
    pub fn view(&self) -> StepView<'_> {
        StepView {
            nodes: &self.nodes,
            slave_nodes: &self.slave_nodes,
            elements: &self.elements,
            conditions: &self.conditions,
            properties: &self.properties,
            info: &self.info,
        }
    }
}

/// Mark of a model in whose steps the first iteration decides the normals of contact.
pub const NORMALS_OF_FIRST_ITERATION: &str = "NORMALS_OF_FIRST_ITERATION";

impl StepView<'_> {
    /// Whether the tangent is the reference program's, which leaves terms out, and not the exact one.
    ///
    /// Contact may keep, for a whole step, the normals there are after its first iteration. The answer then depends on that
    /// iterate, and so on the terms its tangent leaves out: the same terms are left out here. Every other tangent is exact.
    pub fn decides_normals(&self) -> bool {
        self.info.nl_iteration == 1 && self.info.is(NORMALS_OF_FIRST_ITERATION)
    }
}
