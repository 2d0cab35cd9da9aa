//! Flags: named marks of nodes and entities that can be set, unset or undefined.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::diagnostics::Diagnostic;
use crate::registry::{self, Entry};
use crate::{collect_kind, names};

/// The registered name and description of a mark.
pub struct FlagEntry(pub Entry);

impl std::ops::Deref for FlagEntry {
    type Target = Entry;

    fn deref(&self) -> &Entry {
        &self.0
    }
}

collect_kind! { FlagEntry("flag", "unknown-flag") }

/// Makes flags known by name: `register_flags! { pub SLAVE = "…about…"; }`.
#[macro_export]
macro_rules! register_flags {
    ($($vis:vis $name:ident = $about:literal;)*) => { $(
        #[doc = $about]
        $vis const $name: &str = stringify!($name);
        $crate::inventory::submit! { $crate::model::flags::FlagEntry($crate::registry::Entry {
            about: $about, ..$crate::registry::Entry::new(stringify!($name), file!(), line!()) }) }
    )* };
}

register_flags! {
    pub ACTIVE = "Takes part in the computation; undefined counts as set. Of a slave node: in contact, an output.";
    pub INTERFACE = "On a surface that may come into contact; an output.";
    pub MARKER = "Free mark, which nothing reads.";
    pub BOUNDARY = "On the boundary. Free mark, which nothing reads.";
    pub VISITED = "Free mark, which nothing reads.";
    pub TO_ERASE = "To be removed. Free mark, which nothing reads.";
    pub SELECTED = "Free mark, which nothing reads.";
    pub BLOCKED = "Held back. Free mark, which nothing reads.";
    pub RIGID = "Rigid. Free mark, which nothing reads.";
    pub MODIFIED = "Changed. Free mark, which nothing reads.";
    pub STRUCTURE = "Part of a structure. Free mark, which nothing reads.";
    pub FLUID = "Part of a fluid. Free mark, which nothing reads.";
    pub INTERACTION = "Interacts. Free mark, which nothing reads.";
    pub INLET = "On an inlet. Free mark, which nothing reads.";
    pub NEW_ENTITY = "Made by a process, not read from the mesh: several loads of one place are several of them.";
    pub RELATIVE = "Its displacement is a motion of two sides of a cut against each other, as of a bolt's section; its force acts between them.";
    pub OUTLET = "On an outlet. Free mark, which nothing reads.";
}

/// The registered spelling of a flag.
///
/// # Errors
/// `unknown-flag`; the caller adds the place.
pub fn flag(name: &str) -> Result<&'static str, Diagnostic> {
    registry::require::<FlagEntry>(name).map(|entry| entry.name)
}

const UNDEFINED: i8 = -1;

/// Flags of many items, a column a flag; an absent column is undefined everywhere.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Flags {
    #[serde(deserialize_with = "names::read_keys")]
    columns: BTreeMap<&'static str, Vec<i8>>,
}

impl Flags {
    /// Names of the flags that have a column.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.columns.keys().copied()
    }

    /// `Some(state)`, or `None` when undefined.
    pub fn get(&self, flag: &str, index: usize) -> Option<bool> {
        self.columns
            .get(flag)
            .and_then(|column| column.get(index))
            .and_then(|&state| (state >= 0).then_some(state == 1))
    }

    /// Whether the flag is set.
    pub fn is(&self, flag: &str, index: usize) -> bool {
        self.get(flag, index) == Some(true)
    }

    /// Whether the item takes part: [`ACTIVE`] set or undefined.
    pub fn is_active(&self, index: usize) -> bool {
        self.get(ACTIVE, index) != Some(false)
    }

    /// Sets or unsets the flag.
    pub fn set(&mut self, flag: &'static str, index: usize, state: bool) {
        self.put(flag, index, i8::from(state));
    }

    /// Makes the flag undefined.
    pub fn undefine(&mut self, flag: &'static str, index: usize) {
        self.put(flag, index, UNDEFINED);
    }

    fn put(&mut self, flag: &'static str, index: usize, state: i8) {
        let column = self.columns.entry(flag).or_default();
        if column.len() <= index {
            column.resize(index + 1, UNDEFINED);
        }
        column[index] = state;
    }

    /// The flags of the chosen items, in their order.
    pub fn pick(&self, items: &[u32]) -> Self {
        let pick =
            |column: &Vec<i8>| items.iter().map(|&at| column.get(at as usize).copied().unwrap_or(UNDEFINED)).collect();
        Self { columns: self.columns.iter().map(|(name, column)| (*name, pick(column))).collect() }
    }

    /// Adds the flags of others, after those of `count` items.
    pub(super) fn append(&mut self, count: usize, other: &Self) {
        for (name, more) in &other.columns {
            let column = self.columns.entry(name).or_default();
            column.resize(count, UNDEFINED);
            column.extend(more);
        }
    }

    /// Whether they can be those of `count` items.
    pub(super) fn is_sound(&self, count: usize) -> bool {
        self.columns.values().all(|column| column.len() <= count && column.iter().all(|state| (-1..=1).contains(state)))
    }

    /// Makes the flag undefined everywhere.
    pub fn clear(&mut self, flag: &str) {
        self.columns.remove(flag);
    }
}
