//! Names of the reference program that are known and not there.

/// Names of one kind that are known and not there, by how they begin.
pub struct Absent {
    /// The word of their kind.
    pub kind: &'static str,
    /// Beginnings of the names.
    pub stems: &'static [&'static str],
    /// The replacement to use.
    pub remedy: &'static str,
}

inventory::collect!(Absent);

/// Beginnings of names of one kind that are known and not there, each with its replacement, sorted.
pub fn absent(kind: &str) -> Vec<(&'static str, &'static str)> {
    let all = inventory::iter::<Absent>().filter(|absent| absent.kind == kind);
    let mut stems: Vec<_> = all.flat_map(|absent| absent.stems.iter().map(|stem| (*stem, absent.remedy))).collect();
    stems.sort_unstable();
    stems
}

/// Replacement of a known name that is not there; of several beginnings the longest counts.
pub fn instead_of(kind: &str, name: &str) -> Option<&'static str> {
    absent(kind)
        .into_iter()
        .filter(|(stem, _)| name.starts_with(stem))
        .max_by_key(|(stem, _)| stem.len())
        .map(|(_, remedy)| remedy)
}
