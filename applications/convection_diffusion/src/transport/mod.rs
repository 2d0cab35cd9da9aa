//! Semi-Lagrangian advection: values move with a velocity along the paths of points.

mod back_and_forth;
mod locator;
mod mesh;
mod whole;

pub use back_and_forth::{Paths, carried};
pub use locator::Locator;
pub use mesh::Mesh;
pub use whole::Whole;
