//! Forces on interface nodes as a block: friction of contact by constraints.

use zelus_core::model::EntityKind;
use std::ops::Range;

use zelus_core::entities::{EntityBlock, EntityError, LocalSystems, LocalUnknown, StepView, Tangent, Want};
use zelus_core::model::variables::DISPLACEMENT;

/// One force a node, constant during an iteration.
pub(super) struct NodalForces {
    entry: &'static EntityKind,
    nodes: Vec<u32>,
    unknowns: Vec<LocalUnknown>,
    /// Force on each node of the model part.
    pub forces: Vec<[f64; 3]>,
}

impl NodalForces {
    /// No force yet on `nodes` of a part with `count` nodes.
    pub(super) fn new(entry: &'static EntityKind, nodes: Vec<u32>, count: usize, dimension: usize) -> Self {
        let unknowns = (0..dimension as u8).map(|c| LocalUnknown { node: 0, variable: DISPLACEMENT.component(c) });
        Self { entry, nodes, unknowns: unknowns.collect(), forces: vec![[0.0; 3]; count] }
    }
}

impl EntityBlock for NodalForces {
    fn entry(&self) -> &'static EntityKind {
        self.entry
    }

    fn members(&self) -> &[u32] {
        &[]
    }

    fn len(&self) -> usize {
        self.nodes.len()
    }

    fn nodes(&self, at: usize) -> &[u32] {
        &self.nodes[at..=at]
    }

    fn unknowns(&self) -> &[LocalUnknown] {
        &self.unknowns
    }

    fn tangent(&self) -> Tangent {
        Tangent::Zero
    }

    fn is_active(&self, _at: usize, _view: &StepView<'_>) -> bool {
        true
    }

    fn local_systems(
        &self,
        _view: &StepView<'_>,
        range: Range<usize>,
        _want: Want,
        out: &mut LocalSystems,
    ) -> Result<(), EntityError> {
        for (slot, at) in range.enumerate() {
            let force = self.forces[self.nodes[at] as usize];
            let (_, rhs) = out.entity(slot);
            rhs.copy_from_slice(&force[..rhs.len()]);
        }
        Ok(())
    }
}
