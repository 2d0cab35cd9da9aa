//! Interface of a block of pairs to the interaction, for all formulations and shapes.

use std::sync::Arc;

use zelus_core::entities::{EntityBlock, StepView};
use zelus_core::geometry::Nodal;

use super::pair::{Integral, Pair};
use crate::interface::SlaveIndex;
use crate::slave_nodes::SlaveStates;

/// The present state, as pairs are integrated in it.
#[derive(Clone, Copy)]
pub struct IntegrationState<'a> {
    /// Fields and step data.
    pub view: &'a StepView<'a>,
    /// The slave nodes.
    pub states: &'a SlaveStates,
    /// Whether this rank evaluates the pair with these nodes.
    pub own: &'a (dyn Fn(&[u32]) -> bool + Sync),
}

/// A block of pairs as the interaction sees it.
pub trait ContactBlock: EntityBlock {
    /// The pairs.
    fn pairs(&self) -> &[Pair];

    /// The pairs, to change.
    fn pairs_mut(&mut self) -> &mut [Pair];

    /// Slave nodes of the `at`-th pair, in the order of its slave's nodes.
    fn slaves(&self, at: usize) -> &[SlaveIndex];

    /// Mesh nodes of the `at`-th pair's master.
    fn masters(&self, at: usize) -> &[u32];

    /// Takes the states of slave nodes in which the assembly evaluates the block from now on.
    fn set_states(&mut self, states: Arc<SlaveStates>);

    /// Computes the operators of this rank's pairs in the present state. Whatever is asked next of the same state has them.
    fn find_operators(&mut self, present: IntegrationState<'_>);

    /// Gap, slip and area of every pair in the present configuration; those of other ranks stay without overlap.
    fn integrate(&self, present: IntegrationState<'_>) -> Vec<Integral>;

    /// M of every pair in the present state, slave on master (area); `None` of pairs without overlap and of other ranks.
    fn master_weights(&self, present: IntegrationState<'_>) -> Vec<Option<Nodal<Nodal<f64>>>>;

    /// Step start: keeps the operators of the pairs of this rank against which slip is measured.
    fn keep_operators(&mut self, present: IntegrationState<'_>);

    /// Freezes the choices of the integration of this rank's pairs.
    fn freeze_choices(&mut self, present: IntegrationState<'_>);

    /// The same block for the assembly.
    fn as_entities(&self) -> &dyn EntityBlock;
}
