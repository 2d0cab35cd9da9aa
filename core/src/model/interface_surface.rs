//! Surfaces of interfaces: points and facets with columns of their own, for results.
//!
//! Several points may stand at one mesh node, where columns of mesh nodes can only show a mean. Interactions make their surfaces
//! when they are initialised and bring the columns up to date when a step is accepted; output reads them.

use super::fields::Fields;
use super::flags::Flags;
use crate::geometry::Shape;

/// The surface of one interface, whole on every rank.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct InterfaceSurface {
    /// Its name in results.
    pub name: String,
    /// Mesh node of each point; the position of a point is that of its mesh node.
    pub nodes: Vec<u32>,
    /// Number of the patch of each point: points at one mesh node differ in it.
    pub patches: Vec<u32>,
    /// Shape of each facet.
    pub shapes: Vec<Shape>,
    /// Points of each facet in the order of its shape, facet after facet.
    pub points: Vec<u32>,
    /// Columns without history, one entry a point.
    pub values: Fields,
    /// Flags of the points.
    pub flags: Flags,
}

impl InterfaceSurface {
    /// A surface without facets and columns; `points` gives the mesh node and the patch of each point.
    pub fn new(name: impl Into<String>, points: &[(u32, u32)]) -> Self {
        let (nodes, patches) = points.iter().copied().unzip();
        Self { name: name.into(), nodes, patches, values: Fields::new(points.len(), 1), ..Self::default() }
    }

    /// Adds a facet; `points` are as many as its shape has nodes.
    pub fn push(&mut self, shape: Shape, points: impl IntoIterator<Item = u32>) {
        self.shapes.push(shape);
        self.points.extend(points);
    }

    /// The facets: their shapes and points.
    pub fn facets(&self) -> impl Iterator<Item = (Shape, &[u32])> {
        let mut rest = self.points.as_slice();
        self.shapes.iter().map(move |&shape| {
            let (own, others) = rest.split_at(shape.nodes());
            rest = others;
            (shape, own)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facets_take_the_points_of_their_shapes() {
        let mut surface = InterfaceSurface::new("floor", &[(3, 0), (7, 0), (7, 1), (8, 1), (9, 1)]);
        surface.push(Shape::Line2, [0, 1]);
        surface.push(Shape::Line3, [2, 4, 3]);
        let facets: Vec<(Shape, &[u32])> = surface.facets().collect();
        assert_eq!(facets, [(Shape::Line2, &[0, 1][..]), (Shape::Line3, &[2, 4, 3])]);
        assert_eq!((surface.nodes, surface.patches), (vec![3, 7, 7, 8, 9], vec![0, 0, 1, 1, 1]));
        assert_eq!(surface.values.len(), 5);
    }
}
