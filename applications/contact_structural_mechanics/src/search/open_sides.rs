//! Open interfaces, as the choice of their sides sees them.

use crate::interface::{Interface, Patches, SlaveIndex};

/// Bodies and patches from which the sides of an open interface follow.
pub struct OpenSides<'a> {
    /// Bodies of mesh nodes.
    pub bodies: &'a [Option<usize>],
    /// Slave nodes of facets, all of which may be slaves.
    pub patches: &'a Patches,
    /// Number of the interface.
    pub interface: u32,
}

impl<'a> OpenSides<'a> {
    /// Slave nodes of a facet.
    pub(super) fn nodes(&self, interface: &Interface, facet: u32) -> &'a [SlaveIndex] {
        self.patches.of_facet(self.interface, facet, interface.facets[facet as usize].nodes.len())
    }
}

/// Facets whose roles are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Renewal {
    /// All, at the start of a step.
    All,
    /// Open ones, within a step; facets that have crossed in it meet, however deep.
    Open,
}
