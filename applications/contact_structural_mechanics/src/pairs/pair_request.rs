//! Request for a block of pairs.

use std::sync::Arc;

use zelus_core::geometry::{ExactFacet, Shape};
use zelus_core::model::EntityKind;

use super::pair::Pair;
use crate::interface::{Bodies, NormalPatches, SlaveIndex};
use crate::law::StepParameters;
use crate::slave_nodes::SlaveStates;

/// Pairs of two shapes of facets, to make a block of.
pub struct PairRequest {
    /// Shape of the slave facets.
    pub slave: Shape,
    /// Shape of the master facets.
    pub master: Shape,
    /// The registered condition of this shape.
    pub entry: &'static EntityKind,
    /// Exact surfaces of the masters, one a pair; none for masters of elements.
    pub exact: Vec<Arc<(ExactFacet, u32)>>,
    /// The pairs.
    pub pairs: Vec<Pair>,
    /// Node indices of each pair: those around it, master nodes, slave nodes.
    pub nodes: Vec<u32>,
    /// Slave nodes of each pair, in the order of its slave's nodes.
    pub slaves: Vec<SlaveIndex>,
    /// Their owners of unknowns; none for laws without multipliers.
    pub owners: Vec<u32>,
    /// Number of nodes around each pair, which turn the normals of its slave nodes with it or are of the slave's element.
    pub around: usize,
    /// The elements behind slaves, where the formulation takes tractions from them.
    pub bodies: Arc<Bodies>,
    /// The facets around slave nodes.
    pub patches: Arc<NormalPatches>,
    /// Settings and numbers of the step.
    pub parameters: Arc<StepParameters>,
    /// The states of slave nodes.
    pub states: Arc<SlaveStates>,
}
