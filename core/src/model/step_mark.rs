//! Names of the yes-or-no settings in the step data.

/// Name of a yes or no in the step data that one crate sets and reads.
///
/// A constant of this type is the only way to it, so that a name that is misspelt does not compile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StepMark(&'static str);

impl StepMark {
    /// A mark of this name, which no other may have.
    pub const fn new(name: &'static str) -> Self {
        Self(name)
    }

    /// Its name.
    pub const fn name(self) -> &'static str {
        self.0
    }
}
