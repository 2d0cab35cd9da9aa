//! The names of the reference cells.

use serde::{Deserialize, Serialize};

use super::ReferenceCell;
use super::cells::CELLS;

/// One of the reference cells; the number is that of its nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say all; the facts are in the table of reference cells")]
pub enum Shape {
    Point1,
    Line2,
    Line3,
    Tri3,
    Tri6,
    Quad4,
    Quad8,
    Quad9,
    Tet4,
    Tet10,
    Pyramid5,
    Pyramid13,
    Prism6,
    Prism15,
    Prism18,
    Hex8,
    Hex20,
    Hex27,
}

impl Shape {
    /// Every shape, in the order of declaration.
    pub const ALL: [Shape; 18] = [
        Shape::Point1,
        Shape::Line2,
        Shape::Line3,
        Shape::Tri3,
        Shape::Tri6,
        Shape::Quad4,
        Shape::Quad8,
        Shape::Quad9,
        Shape::Tet4,
        Shape::Tet10,
        Shape::Pyramid5,
        Shape::Pyramid13,
        Shape::Prism6,
        Shape::Prism15,
        Shape::Prism18,
        Shape::Hex8,
        Shape::Hex20,
        Shape::Hex27,
    ];

    /// The shape of local dimension `dim` (0 point to 3 solid) with `nodes` nodes, if there is one.
    pub const fn of(dim: usize, nodes: usize) -> Option<Shape> {
        Some(match (dim, nodes) {
            (0, 1) => Shape::Point1,
            (1, 2) => Shape::Line2,
            (1, 3) => Shape::Line3,
            (2, 3) => Shape::Tri3,
            (2, 6) => Shape::Tri6,
            (2, 4) => Shape::Quad4,
            (2, 8) => Shape::Quad8,
            (2, 9) => Shape::Quad9,
            (3, 4) => Shape::Tet4,
            (3, 10) => Shape::Tet10,
            (3, 6) => Shape::Prism6,
            (3, 5) => Shape::Pyramid5,
            (3, 13) => Shape::Pyramid13,
            (3, 15) => Shape::Prism15,
            (3, 18) => Shape::Prism18,
            (3, 8) => Shape::Hex8,
            (3, 20) => Shape::Hex20,
            (3, 27) => Shape::Hex27,
            _ => return None,
        })
    }

    /// The shape of the same kind whose nodes are the corners.
    pub fn linear(self) -> Shape {
        Self::of(self.dim(), self.cell().corners()).expect("every kind has a linear shape")
    }

    /// The constant facts of the shape.
    #[inline]
    pub const fn cell(self) -> &'static ReferenceCell {
        &CELLS[self as usize]
    }

    /// Number of nodes.
    #[inline]
    pub const fn nodes(self) -> usize {
        self.cell().points.len()
    }

    /// Local dimension: 0 point, 1 line, 2 surface, 3 solid.
    #[inline]
    pub const fn dim(self) -> usize {
        self.cell().dim
    }
}
