//! Load conditions: forces on points, lines and surfaces, and boundaries without load.
//!
//! Loads act on the present geometry. Values of the condition and of its nodes (with history) add up. Loads per length
//! or area keep their direction and their amount per present length or area; their change with it is left out of the
//! tangent, being of the order of the strain. Pressure follows the surface, and its tangent is exact.

mod geometry_only;
mod ground_spring;
mod line_load;
mod load;
mod point_load;
mod point_moment;
mod resultant_load;
mod surface_load;
#[cfg(test)]
mod tests;

pub use geometry_only::GeometryOnly;
pub use ground_spring::GroundSpring;
pub use line_load::{LineLoad, SpatialLineLoad};
pub use load::{AtStart, Distributed, DistributedLoad};
pub use point_load::PointLoad;
pub use point_moment::PointMoment;
pub use resultant_load::ResultantLoad;
pub use surface_load::SurfaceLoad;
