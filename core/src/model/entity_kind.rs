//! What a mesh knows of a registered element or condition: its name and its shape.

use std::ops::Deref;

use crate::geometry::Shape;
use crate::registry::Entry;

/// Which table of a model part an entity stands in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// A piece of a body.
    Element,
    /// A piece of a boundary: a load or a contact pair.
    Condition,
}

impl Role {
    /// The word of `zelus list`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Element => "element",
            Self::Condition => "condition",
        }
    }
}

/// A registered element or condition.
pub struct EntityKind {
    /// Name, words and settings.
    pub entry: Entry,
    /// Element or condition.
    pub role: Role,
    /// Reference cell.
    pub cell: Option<Shape>,
    /// Dimensions of the space it lives in: 2 or 3; 0 where that does not matter.
    pub space: usize,
    /// Variables with history that its nodes have: name and number of components.
    pub nodal: &'static [(&'static str, usize)],
    /// Variables of its data by which it loads the model; `None` where that is not stated.
    pub loads: Option<&'static [&'static str]>,
}

impl EntityKind {
    /// A kind on no cell.
    pub const fn new(role: Role, entry: Entry) -> Self {
        Self { entry, role, cell: None, space: 0, nodal: &[], loads: None }
    }

    /// Number of its nodes; 0 without a cell.
    pub fn nodes(&self) -> usize {
        self.cell.map_or(0, Shape::nodes)
    }
}

impl Deref for EntityKind {
    type Target = Entry;

    fn deref(&self) -> &Entry {
        &self.entry
    }
}

impl std::fmt::Debug for EntityKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.role.word(), self.name)
    }
}

impl PartialEq for EntityKind {
    fn eq(&self, other: &Self) -> bool {
        self.role == other.role && self.name == other.name
    }
}
