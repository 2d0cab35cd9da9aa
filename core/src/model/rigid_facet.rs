//! A condition of the mesh that is a facet of a rigid shape.

use crate::geometry::ExactFacet;

/// The part of a rigid shape that a condition stands for. It is made anew in each stage and is in no saved run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidFacet {
    /// The exact surface and the node of its apex (index); `None` where the shape is flat there.
    pub exact: Option<(ExactFacet, u32)>,
}
