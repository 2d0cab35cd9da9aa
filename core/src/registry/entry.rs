//! Data of every registered name, whatever it stands for.

/// A registered name: words, settings and place.
#[derive(Clone, Copy)]
pub struct Entry {
    /// The name decks use.
    pub name: &'static str,
    /// Other names of the same thing.
    pub aliases: &'static [&'static str],
    /// Description, in a sentence.
    pub about: &'static str,
    /// Where its mathematics comes from: equation or literature.
    pub source: &'static str,
    /// Default settings in JSON with a comment on every key; empty when it has none.
    pub defaults: &'static str,
    /// Programs whose own defaults differ: their names, and the keys that differ with their values, JSON with comments.
    pub like: &'static [(&'static str, &'static str)],
    /// Source file of the registration.
    pub file: &'static str,
    /// Line of the registration.
    pub line: u32,
}

impl Entry {
    /// An entry with nothing but its name and place; [`crate::register`] fills in the rest.
    pub const fn new(name: &'static str, file: &'static str, line: u32) -> Self {
        Self { name, aliases: &[], about: "", source: "", defaults: "", like: &[], file, line }
    }

    /// Its name and aliases.
    pub fn names(&self) -> impl Iterator<Item = &'static str> + use<> {
        std::iter::once(self.name).chain(self.aliases.iter().copied())
    }

    /// Whether `name` is its name or an alias.
    pub fn is_called(&self, name: &str) -> bool {
        self.name == name || self.aliases.contains(&name)
    }
}

impl std::fmt::Debug for Entry {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}
