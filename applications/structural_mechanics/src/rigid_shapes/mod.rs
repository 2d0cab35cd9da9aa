//! Rigid shapes: surfaces given by a formula or a list of triangles, which touch deformable bodies as masters of contact.
//!
//! A shape gives facets in axes of its own. Facets of curved parts know the surface exactly ([`zelus_core::geometry::ExactFacet`]), so
//! that contact sees a true sphere or cylinder whatever the size of its facets. A module uses only those above it in the list below.

pub mod shape_facets;
mod exact_surfaces;
pub mod profile;
mod profile_settings;
pub mod rigid_shape;
mod stl;
mod shapes;

pub use profile::{Profile, ProfileFault, Segment};
pub use rigid_shape::{RigidShape, RigidShapeEntry, ShapeRequest};
pub use shape_facets::{ShapeFacet, ShapeFacets};
