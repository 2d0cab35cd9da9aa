//! Reference cells, their shape functions and quadrature, and the maps between local and global coordinates.
//!
//! A [`Shape`] names a cell; its [`ReferenceCell`] holds the constant facts (node order, faces, edges, names in other
//! programs); a [`ShapeTable`] holds shape functions and local gradients at the points of one quadrature rule, ready
//! for kernels; a [`FacetShape`] has the facts of a line or surface for code over facets in any
//! scalar, and [`Nodal`] one value a node of it; an [`ExactFacet`] stands for a part of a surface given by a formula; [`mapping`] works on a cell with given node coordinates. Coordinates are always `[x, y, z]`; planar
//! models leave `z` alone.
mod cells;
mod nodal;
mod facet_shape;
mod exact_facet;
pub mod mapping;
mod sub_facets;
mod quadrature;
mod reference_cell;
mod shape;
mod shape_formulas;
mod shape_functions;
mod shape_table;
#[cfg(test)]
mod tests;

pub use exact_facet::{ExactFacet, ExactFunctions, ExactSurface, Level};
pub use facet_shape::{
    Crossing, FacetShape, LINE_2, LINE_2_APEX, LINE_3, QUADRILATERAL_4, QUADRILATERAL_8, QUADRILATERAL_9, TRIANGLE_3,
    TRIANGLE_3_APEX, TRIANGLE_6, combine, interpolate,
};
pub use nodal::{MOST_FACET_NODES, Nodal};
pub use quadrature::{MAX_ORDER, QuadraturePoint, quadrature};
pub use reference_cell::{Facet, ReferenceCell};
pub use shape::Shape;
pub use shape_functions::{local_gradients, shape_functions};
pub use shape_table::ShapeTable;
pub use sub_facets::{parts, reversed, sub_facets};
