//! Nodes: ids, positions, fields and flags, in ascending order of id.

use serde::{Deserialize, Serialize};

use super::fields::Fields;
use super::fixities::Fixities;
use super::flags::Flags;
use super::index::Index;
use super::rates::Rates;
use super::variable::ScalarVariable;
use crate::vector3::add;

/// All nodes of a model part; an index counts them by ascending id.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Nodes {
    /// Ids as in the mesh file, ascending.
    pub ids: Vec<usize>,
    /// Positions before any displacement.
    pub initial: Vec<[f64; 3]>,
    /// Present positions.
    pub current: Vec<[f64; 3]>,
    /// Columns with history (Kratos: solution step data).
    pub history: Fields,
    /// Columns without history (Kratos: non-historical values).
    pub values: Fields,
    /// Flags.
    pub flags: Flags,
    /// Prescribed unknowns.
    pub fixities: Fixities,
    /// Number of shape changes of the bodies since the run began: data from initial positions are then made anew.
    #[serde(default)]
    pub reshaped: u64,
    #[serde(skip)]
    index: Index,
}

impl Nodes {
    /// Nodes at their initial positions.
    ///
    /// # Panics
    /// When ids are not strictly ascending: the reader sorts them.
    pub fn new(ids: Vec<usize>, initial: Vec<[f64; 3]>) -> Self {
        assert!(ids.windows(2).all(|pair| pair[0] < pair[1]) && ids.len() == initial.len());
        let count = ids.len();
        Self {
            ids,
            current: initial.clone(),
            initial,
            history: Fields::new(count, 1),
            values: Fields::new(count, 1),
            flags: Flags::default(),
            fixities: Fixities::default(),
            reshaped: 0,
            index: Index::default(),
        }
    }

    /// The chosen nodes with all they carry; `nodes` ascends.
    pub fn pick(&self, nodes: &[u32]) -> Self {
        let ids: Vec<usize> = nodes.iter().map(|&at| self.ids[at as usize]).collect();
        Self {
            index: Index::default(),
            ids,
            initial: nodes.iter().map(|&at| self.initial[at as usize]).collect(),
            current: nodes.iter().map(|&at| self.current[at as usize]).collect(),
            history: self.history.pick(nodes),
            values: self.values.pick(nodes),
            flags: self.flags.pick(nodes),
            fixities: self.fixities.pick(nodes),
            reshaped: self.reshaped,
        }
    }

    /// Adds other nodes after its own, whatever their ids.
    pub(super) fn append(&mut self, other: &Self) {
        let count = self.len();
        self.index = Index::default();
        self.ids.extend(&other.ids);
        self.initial.extend(&other.initial);
        self.reshaped = other.reshaped;
        self.current.extend(&other.current);
        self.history.append(&other.history);
        self.values.append(&other.values);
        self.flags.append(count, &other.flags);
        self.fixities.append(count, &other.fixities, other.len());
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// Index of the node with that id.
    pub fn find(&self, id: usize) -> Option<u32> {
        self.index.find(&self.ids, id)
    }

    /// Fixes or frees a variable of some nodes, whether a system solves for it or not.
    pub fn set_fixed(&mut self, variable: ScalarVariable, nodes: &[u32], fixed: bool) {
        self.fixities.set(variable, nodes, fixed, self.ids.len());
    }

    /// Whether a variable of a node is fixed now.
    pub fn is_fixed(&self, variable: ScalarVariable, node: u32) -> bool {
        self.fixities.holds(variable, node)
    }

    /// Gives the bodies another shape during the run: moves nodes with their initial positions by ways, which strains nothing of
    /// itself. Every rank moves the nodes that it has alike.
    pub fn reshape(&mut self, ways: impl IntoIterator<Item = (u32, [f64; 3])>) {
        self.reshaped += 1;
        for (node, way) in ways {
            let node = node as usize;
            self.initial[node] = add(self.initial[node], way);
            self.current[node] = add(self.current[node], way);
        }
    }

    /// Moves one node to its initial position plus the unknown that moves the mesh.
    pub fn follow(&mut self, node: usize) {
        if let Some(moving) = Rates::moving(&self.history) {
            let u = self.history.level(moving, 0);
            self.current[node] = std::array::from_fn(|c| self.initial[node][c] + u[3 * node + c]);
        }
    }

    /// Moves every node as [`Nodes::follow`] does.
    pub fn move_all(&mut self) {
        let Some(moving) = Rates::moving(&self.history) else { return };
        let displacement = self.history.level(moving, 0).chunks_exact(3);
        for ((current, initial), u) in self.current.iter_mut().zip(&self.initial).zip(displacement) {
            *current = [initial[0] + u[0], initial[1] + u[1], initial[2] + u[2]];
        }
    }
}
