//! Reference cells, their shape functions and quadrature, and the maps between local and global coordinates.
//!
//! A [`Shape`] names a cell; its [`ReferenceCell`] holds the constant facts (node order, faces, edges, names in other
//! programs); a [`ShapeTable`] holds shape functions and local gradients at the points of one quadrature rule, ready
//! for kernels; [`mapping`] works on a cell with given node coordinates. Coordinates are always `[x, y, z]`; planar
//! models leave `z` alone.
mod cells;
pub mod mapping;
mod quadrature;
mod reference_cell;
mod shape;
mod shape_functions;
mod shape_table;
#[cfg(test)]
mod tests;

pub use quadrature::{MAX_ORDER, QuadraturePoint, quadrature};
pub use reference_cell::{Facet, ReferenceCell};
pub use shape::Shape;
pub use shape_functions::{Algebra, local_gradients, shape_functions};
pub use shape_table::ShapeTable;
