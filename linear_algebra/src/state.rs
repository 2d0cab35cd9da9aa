//! What something remembers between the steps of a run, as it stands in a file.

use std::any::{Any, type_name};

/// What a participant of a run, as a solver, remembers beside the fields of the model.
///
/// Each type of participant states its own in its own file: a type that serde writes and reads, with
/// `#[typetag::serde] impl State for …`, whose name tags it in the file.
#[typetag::serde]
pub trait State: Any + Send + Sync {}

/// A state that another type of participant has written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("a {found} stands where a {wanted} is needed")]
pub struct WrongState {
    /// The tag it has.
    pub found: &'static str,
    /// The type that is needed.
    pub wanted: &'static str,
}

impl dyn State {
    /// The state as that of its type.
    ///
    /// # Errors
    /// One of another type.
    pub fn take<T: State>(self: Box<Self>) -> Result<T, WrongState> {
        let found = self.typetag_name();
        let any: Box<dyn Any> = self;
        any.downcast::<T>().map(|state| *state).map_err(|_| {
            let wanted = type_name::<T>().rsplit("::").next().unwrap_or_default();
            WrongState { found, wanted }
        })
    }
}
