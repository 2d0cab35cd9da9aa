//! The surfaces that may come into contact: facets, roles, normals, mesh size and the parameters derived from them.

mod facets;
mod nodal_h;
mod normals;
mod parameters;

pub use facets::{Facet, FacetSource, Interface, Roles, interfaces};
pub use nodal_h::find_nodal_h;
pub use normals::{centre_normal, nodal_normals, positions};
pub use parameters::{AlmParameters, alm_parameters};
