//! Cells of the mesh that nothing computes on yet: modelers make elements and conditions of them.

use serde::{Deserialize, Serialize};

use crate::diagnostics::Place;
use crate::geometry::Shape;

/// Geometries in flat arrays, ascending by id.
#[derive(Debug, Default, Clone, PartialEq, Serialize, Deserialize)]
pub struct Geometries {
    /// Ids.
    pub ids: Vec<usize>,
    /// Reference cell of each, and dimensions of the space it lives in: 2 or 3.
    pub cells: Vec<(Shape, usize)>,
    /// Where the mesh file has the first of them.
    pub place: Option<Place>,
    /// Whether anything has been made of them.
    pub used: bool,
    nodes: Vec<Vec<u32>>,
}

impl Geometries {
    /// Adds one, of a larger id than those before; its nodes are node indices in the cell's order.
    pub fn push(&mut self, id: usize, cell: Shape, space: usize, nodes: Vec<u32>) {
        self.ids.push(id);
        self.cells.push((cell, space));
        self.nodes.push(nodes);
    }

    /// Node indices of one geometry.
    pub fn nodes(&self, index: u32) -> &[u32] {
        &self.nodes[index as usize]
    }

    /// Index of the geometry with that id.
    pub fn find(&self, id: usize) -> Option<u32> {
        self.ids.binary_search(&id).ok().map(|at| at as u32)
    }

    /// Whether all lists have one length, ids ascend, and nodes are among `nodes`.
    pub(super) fn is_sound(&self, nodes: usize) -> bool {
        let whole = |(cell, own): (&(Shape, usize), &Vec<u32>)| {
            own.len() == cell.0.nodes() && own.iter().all(|&node| (node as usize) < nodes)
        };
        self.cells.len() == self.ids.len()
            && self.nodes.len() == self.ids.len()
            && self.ids.is_sorted()
            && self.cells.iter().zip(&self.nodes).all(whole)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }
}
