//! Name and shape of a registered element or condition, as a mesh knows it.

use std::ops::Deref;

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::geometry::Shape;
use crate::registry::Entry;

/// Table of a model part in which an entity stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum EntityRole {
    /// A piece of a body.
    Element,
    /// A piece of a boundary: a load or a contact pair.
    Condition,
}

impl EntityRole {
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
    pub role: EntityRole,
    /// Reference cell.
    pub cell: Option<Shape>,
    /// Dimensions of the space it lives in: 2 or 3; 0 where that does not matter.
    pub space: usize,
    /// Whether it is a ring: a piece of a body of revolution, of which the mesh is half a section.
    pub of_revolution: bool,
    /// Whether it is a piece of a body of small displacements: equilibrium is that of the initial configuration.
    pub small_displacement: bool,
    /// Nodal variable of its body load, e.g. an acceleration, and the property that it multiplies, e.g. the density.
    pub body_load: Option<(&'static str, &'static str)>,
    /// Variables with history that its nodes have: name and number of components.
    pub nodal: &'static [(&'static str, usize)],
    /// Variables of its data by which it loads the model; `None` where that is not stated.
    pub loads: Option<&'static [&'static str]>,
    /// Whether its loads are moments: in the plane about the axis across it.
    pub turns: bool,
}

impl EntityKind {
    /// A kind on no cell.
    pub const fn new(role: EntityRole, entry: Entry) -> Self {
        let (of_revolution, small_displacement, turns) = (false, false, false);
        Self {
            entry,
            role,
            cell: None,
            space: 0,
            of_revolution,
            small_displacement,
            body_load: None,
            nodal: &[],
            loads: None,
            turns,
        }
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

/// Finds the registered kinds; submitted by the module that holds the registry of entity blocks.
pub struct KindFinder(pub fn(EntityRole, &str) -> Option<&'static EntityKind>);

inventory::collect!(KindFinder);

/// Writes kinds by name, each name once.
pub(super) fn write_kinds<S: Serializer>(kinds: &[&'static EntityKind], to: S) -> Result<S::Ok, S::Error> {
    let mut names: Vec<(EntityRole, &str)> = kinds.iter().map(|kind| (kind.role, kind.name)).collect();
    names.sort_unstable();
    names.dedup();
    let place = |kind: &&EntityKind| names.binary_search(&(kind.role, kind.name)).expect("it is one of them") as u32;
    let places: Vec<u32> = kinds.iter().map(place).collect();
    (&names, places).serialize(to)
}

/// Reads the kinds that [`write_kinds`] has written.
pub(super) fn read_kinds<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<&'static EntityKind>, D::Error> {
    let (names, places) = <(Vec<(EntityRole, String)>, Vec<u32>)>::deserialize(from)?;
    let find = |(role, name): &(EntityRole, String)| {
        let found = inventory::iter::<KindFinder>().find_map(|finder| finder.0(*role, name));
        found.ok_or_else(|| D::Error::custom(format!("there is no {} {name}", role.word())))
    };
    let kinds = names.iter().map(find).collect::<Result<Vec<_>, _>>()?;
    let kind = |place: u32| kinds.get(place as usize).copied().ok_or_else(|| D::Error::custom("a kind without a name"));
    places.into_iter().map(kind).collect()
}
