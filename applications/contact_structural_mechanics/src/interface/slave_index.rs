//! Index of a slave node.

use serde::{Deserialize, Serialize};

/// Index of a slave node of an interaction.
///
/// A slave node is a node of a patch. Slave nodes stand in the order of their mesh nodes, those at one mesh node in the order of
/// their patches, the same on all ranks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize)]
pub struct SlaveIndex(pub u32);

impl SlaveIndex {
    /// The place in a list of all slave nodes.
    #[inline]
    pub fn place(self) -> usize {
        self.0 as usize
    }
}
