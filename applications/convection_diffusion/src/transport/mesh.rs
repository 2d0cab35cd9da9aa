//! A mesh that paths lead through.

use zelus_core::geometry::Shape;

/// Elements that fill space, and where their nodes are.
pub struct Mesh<'a> {
    /// Positions of the nodes.
    pub positions: Vec<[f64; 3]>,
    /// Shapes and nodes of the elements.
    pub elements: &'a [(Shape, Vec<u32>)],
}

impl Mesh<'_> {
    /// Positions of the nodes of an element.
    pub fn corners(&self, element: u32) -> Vec<[f64; 3]> {
        self.elements[element as usize].1.iter().map(|&node| self.positions[node as usize]).collect()
    }
}
