//! Everything that a deck names, found by that name.
//!
//! Each kind of object has a typed entry, which stands beside the trait it makes objects of: `processes::ProcessEntry`,
//! `entities::ElementEntry`, … An object registers itself in its own file with [`crate::register`]; nothing else has to
//! change. [`crate::registered_kind`] declares a kind, in any crate. `zelus list` and `zelus describe` read the same
//! entries, and so does the check of a deck.

mod absent;
mod entry;
mod macros;
mod named;

use std::collections::BTreeMap;

pub use absent::{Absent, absent, instead_of};
pub use entry::Entry;
pub use named::named;

use crate::diagnostics::{Diagnostic, did_you_mean};

/// A kind of thing that a deck can name: the type of its entries.
pub trait Registered: inventory::Collect {
    /// The word of `zelus list`.
    const KIND: &'static str;

    /// Code of the error for a name that is not there.
    const UNKNOWN: &'static str;

    /// Name, words and settings.
    fn entry(&self) -> &Entry;
}

/// A kind, for those who look through all of them.
#[derive(Clone, Copy)]
pub struct Kind {
    /// The word of `zelus list`.
    pub word: &'static str,
    /// Code of the error for a name that is not there.
    pub unknown: &'static str,
    /// Its entries, in no order.
    pub entries: fn() -> Vec<&'static Entry>,
}

inventory::collect!(Kind);

impl Kind {
    /// The kind of these entries.
    pub const fn of<R: Registered>() -> Self {
        Self {
            word: R::KIND,
            unknown: R::UNKNOWN,
            entries: || inventory::iter::<R>.into_iter().map(Registered::entry).collect(),
        }
    }

    /// Names and aliases, sorted.
    pub fn names(&self) -> Vec<&'static str> {
        let mut names: Vec<&'static str> = (self.entries)().into_iter().flat_map(Entry::names).collect();
        names.sort_unstable();
        names
    }

    /// Error for a name that is not there; the caller adds the place.
    pub fn unknown(&self, name: &str) -> Diagnostic {
        let fact = format!("there is no {} {name:?}", self.word.replace('_', " "));
        Diagnostic::error(self.unknown, fact).remedy(self.remedy(name))
    }

    /// Remedy for a name that is not there: the replacement, or the nearest names.
    pub fn remedy(&self, name: &str) -> String {
        let instead = instead_of(self.word, name).map(str::to_owned);
        instead
            .or_else(|| did_you_mean(name, self.names()))
            .unwrap_or_else(|| format!("`zelus list {}` shows what there is", self.word))
    }
}

/// The entry of that name or alias of the kind with that word, for code that must not know the kind's crate.
///
/// # Errors
/// As [`require`].
pub fn require_of(word: &'static str, name: &str) -> Result<&'static Entry, Diagnostic> {
    let kind = kinds().into_iter().find(|kind| kind.word == word);
    let missing = Kind { word, unknown: "unknown-name", entries: Vec::new };
    let found = kind.and_then(|kind| (kind.entries)().into_iter().find(|entry| entry.is_called(name)));
    found.ok_or_else(|| kind.unwrap_or(&missing).unknown(name))
}

/// All kinds, sorted by their words.
pub fn kinds() -> Vec<&'static Kind> {
    let mut all: Vec<_> = inventory::iter::<Kind>().collect();
    all.sort_by_key(|kind| kind.word);
    all
}

/// The entries of all kinds, sorted by kind and name, each with the word of its kind.
pub fn entries() -> Vec<(&'static str, &'static Entry)> {
    let mut all: Vec<_> =
        kinds().into_iter().flat_map(|kind| (kind.entries)().into_iter().map(|entry| (kind.word, entry))).collect();
    all.sort_by_key(|(word, entry)| (*word, entry.name, entry.file, entry.line));
    all
}

/// The entries of one kind, sorted by name.
pub fn all<R: Registered>() -> Vec<&'static R> {
    let all: Vec<&'static R> = inventory::iter::<R>.into_iter().collect();
    let names: Vec<&str> = all.iter().map(|registered| registered.entry().name).collect();
    order_of(&names).into_iter().map(|at| all[at]).collect()
}

/// Places of names in their order.
fn order_of(names: &[&str]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..names.len()).collect();
    order.sort_by_key(|&at| names[at]);
    order
}

/// Names and aliases of a kind, sorted.
pub fn names<R: Registered>() -> Vec<&'static str> {
    Kind::of::<R>().names()
}

/// The entry of that name or alias.
pub fn find<R: Registered>(name: &str) -> Option<&'static R> {
    inventory::iter::<R>.into_iter().find(|registered| registered.entry().is_called(name))
}

/// As [`find`].
///
/// # Errors
/// As [`Kind::unknown`].
pub fn require<R: Registered>(name: &str) -> Result<&'static R, Diagnostic> {
    find(name).ok_or_else(|| Kind::of::<R>().unknown(name))
}

/// Names registered more than once, with both places; empty when all is well.
pub fn duplicates() -> Vec<String> {
    let mut seen: BTreeMap<(&str, &str), &Entry> = BTreeMap::new();
    let mut out = Vec::new();
    for (kind, entry) in entries() {
        for name in entry.names() {
            if let Some(first) = seen.insert((kind, name), entry) {
                out.push(format!("{kind} {name}: {}:{} and {}:{}", first.file, first.line, entry.file, entry.line));
            }
        }
    }
    out
}
