//! Semi-Lagrangian advection: values move with a velocity along the paths of points.

mod back_and_forth;
mod locator;
mod mesh;
mod whole_mesh;

pub use back_and_forth::{Paths, advected};
pub use locator::Locator;
pub use mesh::Mesh;
pub use whole_mesh::WholeMesh;
