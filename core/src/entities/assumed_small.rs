//! A number that the theory of an entity takes to be small.

/// A number of the present state that the theory of an entity takes to be small, e.g. the strain of elements for small displacements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AssumedSmall {
    /// Name of the number, e.g. "strain".
    pub name: &'static str,
    /// Its size in the present state (at least 0).
    pub value: f64,
    /// Size from which on results of the theory are wrong (above 0).
    pub limit: f64,
    /// Remedy: the theory that holds for larger ones.
    pub remedy: &'static str,
}

impl AssumedSmall {
    /// Ratio of the size to its limit.
    pub fn ratio(&self) -> f64 {
        self.value / self.limit
    }
}
