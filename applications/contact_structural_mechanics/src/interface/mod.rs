//! The surfaces that may come into contact: facets, roles, normals, mesh size and the parameters derived from them.

mod contact_part;
mod bodies;
mod facet;
mod facets;
mod fixed;
mod nodal_h;
mod patches;
mod normals;
mod parameters;
mod sections;
mod slave_index;
mod symmetry_planes;

pub use bodies::{Bodies, Tractions};
pub use contact_part::add_contact_part;
pub use facet::{Facet, FacetSource, Positions, Roles};
pub use facets::{
    Interface, check_nodes, check_parts, interfaces, notes_of_bodies, set_sides, sides, slave_nodes,
    slaves_without_master, warnings_of_pairs,
};
pub use fixed::{Fixed, FixedDirections, fixed_directions};
pub use nodal_h::find_nodal_h;
pub use normals::{FacetCorner, NodalNormals, NormalPatches, nodal_normals};
pub use parameters::{AlmParameters, GivenParameters, alm_parameters};
pub use patches::{FEATURE_ANGLE, Patches};
pub use sections::unlike_sections;
pub use slave_index::SlaveIndex;
pub use symmetry_planes::symmetry_planes;
