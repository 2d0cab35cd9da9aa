//! Reference cells, their shape functions and quadrature, and the maps between local and global coordinates.
//!
//! A [`Shape`] names a cell; its [`ReferenceCell`] holds the constant facts (node order, faces, edges, names in other
//! programs); a [`ShapeTable`] holds shape functions and local gradients at the points of one quadrature rule, ready
//! for kernels; a [`FacetShape`] is a line or surface as a type, for code compiled for it and for any
//! scalar; [`mapping`] works on a cell with given node coordinates. Coordinates are always `[x, y, z]`; planar
//! models leave `z` alone.
mod cells;
mod facet_shape;
pub mod mapping;
mod pieces;
mod quadrature;
mod reference_cell;
mod shape;
mod shape_functions;
mod shape_table;
#[cfg(test)]
mod tests;

pub use facet_shape::{
    FacetShape, Line2, Line3, NodeArray, NodeValue, Quadrilateral4, Quadrilateral8, Quadrilateral9, Triangle3,
    Triangle6,
};
pub use pieces::{parts, pieces, reversed};
pub use quadrature::{MAX_ORDER, QuadraturePoint, quadrature};
pub use reference_cell::{Facet, ReferenceCell};
pub use shape::Shape;
pub use shape_functions::{local_gradients, shape_functions};
pub use shape_table::ShapeTable;
