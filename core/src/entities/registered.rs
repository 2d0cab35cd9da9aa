//! The registered elements and conditions: a kind of the mesh and the object that computes it.

use std::ops::Deref;

use super::block::{BlockRequest, EntityBlock};
use crate::collect_kind;
use crate::diagnostics::{Diagnostic, Result};
use crate::geometry::Shape;
use crate::model::{EntityKind, EntityRole, KindFinder};
use crate::registry::{self, Entry};

/// Makes the block of entities of one kind.
pub type BlockFactory = fn(&BlockRequest<'_>) -> Result<Box<dyn EntityBlock>>;

/// Objects that compute the entities of a kind.
#[derive(Clone, Copy)]
pub enum Build {
    /// A block of those of the mesh.
    Block(BlockFactory),
    /// Blocks of the pairs that a search makes; a mesh cannot have them.
    Pairs,
    /// Nothing: a place of the mesh where a solver puts elements of its own.
    Place,
}

/// Declares the entries of one table.
macro_rules! entity_entry {
    ($(#[$doc:meta])* $type:ident, $role:ident($word:literal, $unknown:literal)) => {
        $(#[$doc])*
        pub struct $type {
            kind: EntityKind,
            /// Object that computes its entities.
            pub build: Build,
        }

        impl $type {
            /// For [`crate::register`].
            pub const fn new(entry: Entry, build: Build) -> Self {
                Self { kind: EntityKind::new(EntityRole::$role, entry), build }
            }

            /// Its reference cell.
            pub const fn cell(mut self, cell: Option<Shape>) -> Self {
                self.kind.cell = cell;
                self
            }

            /// Dimensions of the space it lives in.
            pub const fn space(mut self, space: usize) -> Self {
                self.kind.space = space;
                self
            }

            /// Whether it is a ring of a body of revolution.
            pub const fn of_revolution(mut self, of_revolution: bool) -> Self {
                self.kind.of_revolution = of_revolution;
                self
            }

            /// Whether it is a piece of a body of small displacements.
            pub const fn small_displacement(mut self, small_displacement: bool) -> Self {
                self.kind.small_displacement = small_displacement;
                self
            }

            /// Nodal variable of its body load, and the property that it multiplies.
            pub const fn body_load(mut self, body_load: (&'static str, &'static str)) -> Self {
                self.kind.body_load = Some(body_load);
                self
            }

            /// Variables of its data by which it loads the model.
            pub const fn loads(mut self, loads: &'static [&'static str]) -> Self {
                self.kind.loads = Some(loads);
                self
            }

            /// Whether its loads are moments: in the plane about the axis across it.
            pub const fn turns(mut self, turns: bool) -> Self {
                self.kind.turns = turns;
                self
            }

            /// Variables with history that its nodes have: name and number of components.
            pub const fn nodal(mut self, nodal: &'static [(&'static str, usize)]) -> Self {
                self.kind.nodal = nodal;
                self
            }
        }

        impl Deref for $type {
            type Target = EntityKind;

            fn deref(&self) -> &EntityKind {
                &self.kind
            }
        }

        collect_kind! { $type($word, $unknown) }
    };
}

entity_entry! {
    /// A registered element: a piece of a body.
    ElementEntry, Element("element", "unknown-element")
}
entity_entry! {
    /// A registered condition: a piece of a boundary, or a pair of them.
    ConditionEntry, Condition("condition", "unknown-condition")
}

/// The registered kind of that name or alias.
pub fn find_kind(role: EntityRole, name: &str) -> Option<&'static EntityKind> {
    match role {
        EntityRole::Element => registry::find::<ElementEntry>(name).map(|entry| &**entry),
        EntityRole::Condition => registry::find::<ConditionEntry>(name).map(|entry| &**entry),
    }
}

inventory::submit! { KindFinder(find_kind) }

/// As [`find_kind`].
///
/// # Errors
/// As [`registry::require`].
pub fn require_kind(role: EntityRole, name: &str) -> Result<&'static EntityKind, Diagnostic> {
    match role {
        EntityRole::Element => registry::require::<ElementEntry>(name).map(|entry| &**entry),
        EntityRole::Condition => registry::require::<ConditionEntry>(name).map(|entry| &**entry),
    }
}

/// Names and aliases of the registered kinds, sorted.
pub fn kind_names(role: EntityRole) -> Vec<&'static str> {
    match role {
        EntityRole::Element => registry::names::<ElementEntry>(),
        EntityRole::Condition => registry::names::<ConditionEntry>(),
    }
}

/// Whether a kind is a place of the mesh without physics.
pub fn is_place(kind: &EntityKind) -> bool {
    kind.role == EntityRole::Element
        && registry::find::<ElementEntry>(kind.name).is_some_and(|entry| matches!(entry.build, Build::Place))
}

/// Factory of blocks of a registered kind; `None` for one that is not registered, for pairs and for places.
pub fn block_factory(kind: &EntityKind) -> Option<BlockFactory> {
    let build = match kind.role {
        EntityRole::Element => registry::find::<ElementEntry>(kind.name)?.build,
        EntityRole::Condition => registry::find::<ConditionEntry>(kind.name)?.build,
    };
    match build {
        Build::Block(make) => Some(make),
        Build::Pairs | Build::Place => None,
    }
}

/// The registered kinds that make blocks of a mesh, elements first.
pub fn block_kinds() -> Vec<&'static EntityKind> {
    let elements = registry::all::<ElementEntry>().into_iter().map(|entry| (&**entry, entry.build));
    let conditions = registry::all::<ConditionEntry>().into_iter().map(|entry| (&**entry, entry.build));
    elements.chain(conditions).filter(|(_, build)| matches!(build, Build::Block(_))).map(|(kind, _)| kind).collect()
}
