//! Variables: named, typed quantities of nodes, entities, properties and steps.

use std::collections::BTreeMap;
use std::fmt;
use std::marker::PhantomData;
use std::sync::LazyLock;

use serde::{Deserialize, Serialize};

use crate::collect_kind;
use crate::names::{self, Name};
use crate::registry::{self, Entry};

/// Kind of the values of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VariableKind {
    /// One number.
    Scalar,
    /// Three numbers, addressed as `NAME_X`, `NAME_Y`, `NAME_Z`.
    Vector3,
    /// A list of numbers of any length, e.g. a stress in Voigt form.
    Vector,
    /// A rectangular table of numbers.
    Matrix,
    /// True or false.
    Boolean,
    /// A whole number.
    Integer,
    /// A word.
    Text,
}

/// A Rust type that a nodal column can hold.
pub trait ColumnType: Copy + 'static {
    /// Numbers a value takes.
    const COMPONENTS: usize;
    /// The kind, for the registry.
    const KIND: VariableKind;
}

impl ColumnType for f64 {
    const COMPONENTS: usize = 1;
    const KIND: VariableKind = VariableKind::Scalar;
}

impl ColumnType for [f64; 3] {
    const COMPONENTS: usize = 3;
    const KIND: VariableKind = VariableKind::Vector3;
}

/// A typed handle of a variable that a column can hold; made by [`crate::register_variable`].
pub struct Variable<T> {
    name: &'static str,
    holds: PhantomData<fn() -> T>,
}

impl<T> Variable<T> {
    /// The handle of the variable called `name`; use [`crate::register_variable`], which also makes it known.
    pub const fn new(name: &'static str) -> Self {
        Self { name, holds: PhantomData }
    }

    /// The name decks use.
    pub const fn name(&self) -> &'static str {
        self.name
    }
}

impl Variable<f64> {
    /// The scalar itself as an unknown.
    pub const fn scalar(&self) -> ScalarVariable {
        ScalarVariable { column: self.name, component: None }
    }
}

impl Variable<[f64; 3]> {
    /// One component (0, 1, 2 for X, Y, Z) as an unknown.
    pub const fn component(&self, index: u8) -> ScalarVariable {
        ScalarVariable { column: self.name, component: Some(index) }
    }
}

/// One number of a column: a scalar variable or a component of a vector variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct ScalarVariable {
    /// Name of the column that holds it.
    #[serde(deserialize_with = "names::read")]
    pub column: Name,
    /// 0, 1, 2 for X, Y, Z; `None` when the column is a scalar.
    pub component: Option<u8>,
}

impl ScalarVariable {
    /// Offset inside the column's value.
    pub fn offset(&self) -> usize {
        usize::from(self.component.unwrap_or(0))
    }
}

impl fmt::Display for ScalarVariable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.component {
            None => f.write_str(self.column),
            Some(c) => write!(f, "{}_{}", self.column, ["X", "Y", "Z"][usize::from(c)]),
        }
    }
}

/// The registered facts of a variable; its description has definition, unit and sign.
#[derive(Debug)]
pub struct VariableEntry {
    entry: Entry,
    /// Kind of its values.
    pub kind: VariableKind,
}

impl VariableEntry {
    /// For [`crate::register_variable`].
    pub const fn new(entry: Entry, kind: VariableKind) -> Self {
        Self { entry, kind }
    }
}

impl std::ops::Deref for VariableEntry {
    type Target = Entry;

    fn deref(&self) -> &Entry {
        &self.entry
    }
}

collect_kind! { VariableEntry("variable", "unknown-variable") }

static VARIABLES: LazyLock<BTreeMap<&'static str, &'static VariableEntry>> =
    LazyLock::new(|| registry::all::<VariableEntry>().into_iter().map(|entry| (entry.name, entry)).collect());

/// All registered variables by name.
pub fn variables() -> &'static BTreeMap<&'static str, &'static VariableEntry> {
    &VARIABLES
}

/// Variable or component that a name in a deck refers to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Named {
    /// A whole variable.
    Whole(&'static str, VariableKind),
    /// A component of a vector variable.
    Component(ScalarVariable),
}

impl Named {
    /// Name of the column and the number of values read from it with their offset.
    pub fn column(&self) -> (&'static str, usize, usize) {
        match self {
            Self::Whole(name, VariableKind::Vector3) => (name, 0, 3),
            Self::Whole(name, _) => (name, 0, 1),
            Self::Component(scalar) => (scalar.column, scalar.offset(), 1),
        }
    }
}

/// The variable or component called `name`, or `None`.
pub fn named(name: &str) -> Option<Named> {
    if let Some(entry) = VARIABLES.get(name) {
        return Some(Named::Whole(entry.name, entry.kind));
    }
    let (stem, last) = name.rsplit_once('_')?;
    let component = match last {
        "X" => 0,
        "Y" => 1,
        "Z" => 2,
        _ => return None,
    };
    let entry = VARIABLES.get(stem).filter(|entry| entry.kind == VariableKind::Vector3)?;
    Some(Named::Component(ScalarVariable { column: entry.name, component: Some(component) }))
}

/// Makes variables known by name and defines their handles.
///
/// `register_variable! { pub DISPLACEMENT: [f64; 3] = "…about…"; }` for columns, and
/// `register_variable! { kind YOUNG_MODULUS: Scalar = "…about…"; }` for names without a handle.
#[macro_export]
macro_rules! register_variable {
    () => {};
    (@ $name:ident, $kind:expr, $about:literal) => {
        $crate::inventory::submit! { $crate::model::VariableEntry::new(
            $crate::registry::Entry { about: $about, ..$crate::registry::Entry::new(stringify!($name), file!(), line!()) },
            $kind,
        ) }
    };
    (kind $name:ident : $kind:ident = $about:literal; $($rest:tt)*) => {
        $crate::register_variable! { @ $name, $crate::model::VariableKind::$kind, $about }
        $crate::register_variable! { $($rest)* }
    };
    ($vis:vis $name:ident : $type:ty = $about:literal; $($rest:tt)*) => {
        #[doc = $about]
        $vis static $name: $crate::model::Variable<$type> = $crate::model::Variable::new(stringify!($name));
        $crate::register_variable! { @ $name, <$type as $crate::model::ColumnType>::KIND, $about }
        $crate::register_variable! { $($rest)* }
    };
}
