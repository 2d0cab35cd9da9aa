//! The rigid shapes, one a file.

mod cone;
mod cylinder;
mod extrusion;
mod plane;
mod revolution;
mod sphere;
mod stl_surface;
mod torus;
