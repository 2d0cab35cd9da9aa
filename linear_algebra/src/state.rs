//! State that an object keeps between the steps of a run, as it stands in a file.

use std::any::{Any, type_name};
use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

/// State of a participant of a run, e.g. a solver, beside the fields of the model.
///
/// Each type of participant states its own in its own file: a type that serde writes and reads, with
/// `#[typetag::serde] impl State for …`, whose name tags it in the file.
#[typetag::serde]
pub trait State: Any + Send + Sync {
    /// Shows its data of nodes and unknowns to a mapper, which maps them to other ranks, and drops data that are cheap to make again
    /// and belong to the old ranks. The sequence of its calls must not depend on which of the ranks it is.
    fn remap(&mut self, mapper: &mut dyn StateMapper);
}

/// Maps states of ranks to other ranks that run the same deck.
///
/// It visits the states of all earlier ranks, then that of a new one at its start. At last it visits that of the first rank once more,
/// and writes the state of the new one into it.
pub trait StateMapper {
    /// Indices of nodes that every rank has.
    fn nodes(&mut self, nodes: &mut [u32]);

    /// As many numbers a node for each node of the rank, node by node; or none at all.
    fn by_node(&mut self, values: &mut Vec<f64>);

    /// A number an unknown; or none at all.
    fn by_unknown(&mut self, values: &mut Vec<f64>);

    /// From here on unknowns are these; gives those before.
    fn begin_unknowns(&mut self, unknowns: &Unknowns) -> Unknowns;
}

impl dyn StateMapper + '_ {
    /// The keys of a map, which are nodes that every rank has.
    pub fn node_map<T>(&mut self, map: &mut BTreeMap<u32, T>) {
        let (mut nodes, values): (Vec<u32>, Vec<T>) = std::mem::take(map).into_iter().unzip();
        self.nodes(&mut nodes);
        *map = nodes.into_iter().zip(values).collect();
    }

    /// A set of nodes that every rank has.
    pub fn node_set(&mut self, set: &mut BTreeSet<u32>) {
        let mut nodes: Vec<u32> = std::mem::take(set).into_iter().collect();
        self.nodes(&mut nodes);
        *set = nodes.into_iter().collect();
    }

    /// Nodes that every rank has, with something beside each.
    pub fn node_list<T>(&mut self, list: &mut [(u32, T)]) {
        let mut nodes: Vec<u32> = list.iter().map(|(node, _)| *node).collect();
        self.nodes(&mut nodes);
        list.iter_mut().zip(nodes).for_each(|((node, _), new)| *node = new);
    }
}

/// The unknowns of a rank: numbers of nodes that follow each other, and the names of the unknowns that each of them has.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Unknowns(pub Vec<(u32, Vec<String>)>);

impl Unknowns {
    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.0.iter().map(|(nodes, names)| *nodes as usize * names.len()).sum()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// A state that another type of participant has written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("a {found} stands where a {wanted} is needed")]
pub struct WrongState {
    /// The tag it has.
    pub found: &'static str,
    /// The type that is needed.
    pub wanted: &'static str,
}

impl dyn State {
    /// The state as that of its type.
    ///
    /// # Errors
    /// One of another type.
    pub fn take<T: State>(self: Box<Self>) -> Result<T, WrongState> {
        let found = self.typetag_name();
        let any: Box<dyn Any> = self;
        any.downcast::<T>().map(|state| *state).map_err(|_| {
            let wanted = type_name::<T>().rsplit("::").next().unwrap_or_default();
            WrongState { found, wanted }
        })
    }
}
