//! Values carried along with a velocity, along the paths of points.

mod back_and_forth;
mod locator;

pub use back_and_forth::{Paths, carried};
pub use locator::Locator;
