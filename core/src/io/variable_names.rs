//! Names of variables and laws as input files spell them.

use crate::diagnostics::Diagnostic;
use crate::model::{Named, VariableEntry, VariableKind, named, variables};
use crate::registry::{self, Kind};

/// The kind of laws, which applications declare.
const LAW: &str = "constitutive_law";

/// Kind of the variable (or component) called `name`; `None` when there is none.
pub(super) fn kind_of(name: &str) -> Option<VariableKind> {
    named(name).map(|named| match named {
        Named::Whole(_, kind) => kind,
        Named::Component(_) => VariableKind::Scalar,
    })
}

/// The error that names the nearest variable; the caller adds the place.
pub(crate) fn unknown_variable(name: &str) -> Diagnostic {
    Kind::of::<VariableEntry>().unknown(name)
}

/// Why a variable that decks name has no values here; `None` when it has.
pub(crate) fn not_computed(name: &str) -> Option<&'static str> {
    variables().get(name)?.about.strip_prefix("Not computed: ")
}

/// The warning for a variable that is known and read by nothing; the caller adds the place.
pub(crate) fn without_effect(name: &str) -> Option<Diagnostic> {
    let why = variables().get(name)?.about.strip_prefix("Without effect: ").or_else(|| not_computed(name))?;
    let fact = format!("{name} is read and changes nothing: {why}");
    Some(Diagnostic::warning("variable-without-effect", fact).remedy("remove it, if its effect is not expected"))
}

/// The registered name of a constitutive law that may be spelt with its application before a dot.
pub(super) fn law_name(name: &str) -> Result<String, Diagnostic> {
    let last = last_of_path(name);
    registry::require_of(LAW, last).map(|entry| entry.name.to_owned())
}

/// The name of the law that a factory of Kratos, `…Factory`, makes of a yield surface and a plastic potential.
pub(super) fn composed_law(name: &str, parts: [&str; 2], domain_size: usize) -> Option<String> {
    let stem = last_of_path(name).strip_suffix("Factory")?;
    let space = if domain_size == 2 { "PlaneStrain" } else { "3D" };
    Some(format!("{stem}{space}{}{}", parts[0], parts[1]))
}

/// The name without the dotted application before it.
pub(super) fn last_of_path(name: &str) -> &str {
    name.rsplit('.').next().unwrap_or(name)
}
