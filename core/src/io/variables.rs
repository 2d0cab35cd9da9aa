//! Names of variables and laws as input files spell them.

use crate::diagnostics::{Diagnostic, did_you_mean};
use crate::model::{Named, VariableKind, named, variables};
use crate::registry::{self, Kind};

/// What the variable (or component) called `name` holds; `None` when there is none.
pub(super) fn kind_of(name: &str) -> Option<VariableKind> {
    named(name).map(|named| match named {
        Named::Whole(_, kind) => kind,
        Named::Component(_) => VariableKind::Scalar,
    })
}

/// The error that says what was meant; the caller adds the place.
pub(crate) fn unknown_variable(name: &str) -> Diagnostic {
    let remedy = did_you_mean(name, variables().keys().copied());
    let remedy = remedy.unwrap_or_else(|| "`zelus list variable` shows the known ones".to_owned());
    Diagnostic::error("unknown-variable", format!("there is no variable {name}")).remedy(remedy)
}

/// The registered name of a constitutive law that may be spelt with its application before a dot.
pub(super) fn law_name(name: &str) -> Result<String, Diagnostic> {
    let last = last_of_path(name);
    registry::require(Kind::ConstitutiveLaw, last).map(|entry| entry.name.to_owned())
}

/// The name without the dotted application before it.
pub(super) fn last_of_path(name: &str) -> &str {
    name.rsplit('.').next().unwrap_or(name)
}
