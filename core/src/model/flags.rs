//! Flags: named marks of nodes and entities that can be set, unset or undefined.

use std::collections::BTreeMap;

use crate::diagnostics::did_you_mean;

/// Names of flags; Kratos' own.
pub const FLAGS: &[&str] = &[
    ACTIVE,
    SLAVE,
    MASTER,
    INTERFACE,
    SLIP,
    ISOLATED,
    CONTACT,
    MARKER,
    BOUNDARY,
    VISITED,
    TO_ERASE,
    SELECTED,
    BLOCKED,
    RIGID,
    MODIFIED,
    STRUCTURE,
    FLUID,
    INTERACTION,
    INLET,
    OUTLET,
];
/// Takes part in the computation; undefined counts as set.
pub const ACTIVE: &str = "ACTIVE";
/// On the side of a contact pair that carries the multipliers.
pub const SLAVE: &str = "SLAVE";
/// On the other side of a contact pair.
pub const MASTER: &str = "MASTER";
/// On a surface that may come into contact.
pub const INTERFACE: &str = "INTERFACE";
/// Slides.
pub const SLIP: &str = "SLIP";
/// A contact pair whose sides do not overlap.
pub const ISOLATED: &str = "ISOLATED";
/// Part of a contact problem.
pub const CONTACT: &str = "CONTACT";
/// Free mark.
pub const MARKER: &str = "MARKER";
/// On the boundary.
pub const BOUNDARY: &str = "BOUNDARY";
/// Free mark.
pub const VISITED: &str = "VISITED";
/// To be removed.
pub const TO_ERASE: &str = "TO_ERASE";
/// Free mark.
pub const SELECTED: &str = "SELECTED";
/// Held back.
pub const BLOCKED: &str = "BLOCKED";
/// Rigid; in MPC contact, tied for good.
pub const RIGID: &str = "RIGID";
/// Changed.
pub const MODIFIED: &str = "MODIFIED";
/// Part of a structure.
pub const STRUCTURE: &str = "STRUCTURE";
/// Part of a fluid.
pub const FLUID: &str = "FLUID";
/// Interacts.
pub const INTERACTION: &str = "INTERACTION";
/// On an inlet.
pub const INLET: &str = "INLET";
/// On an outlet.
pub const OUTLET: &str = "OUTLET";

/// The registered spelling of a flag, or the words that suggest one.
///
/// # Errors
/// The text of a "did you mean" when the name is not known.
pub fn flag(name: &str) -> Result<&'static str, String> {
    FLAGS.iter().copied().find(|known| *known == name).ok_or_else(|| {
        did_you_mean(name, FLAGS.iter().copied()).unwrap_or_else(|| format!("known flags: {}", FLAGS.join(", ")))
    })
}

const UNDEFINED: i8 = -1;

/// Flags of many items, a column a flag; an absent column is undefined everywhere.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Flags {
    columns: BTreeMap<&'static str, Vec<i8>>,
}

impl Flags {
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

    /// Makes the flag undefined everywhere.
    pub fn clear(&mut self, flag: &str) {
        self.columns.remove(flag);
    }
}
