//! Kinds of contact constraints, by their names in decks.

use zelus_core::Result;
use zelus_core::diagnostics::did_you_mean;
use zelus_core::parameters::Settings;

/// Kind of contact constraints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MpcKind {
    /// Contact without friction.
    Frictionless,
    /// Contact with Coulomb friction.
    Frictional,
    /// All overlaps are tied for good.
    MeshTying,
}

/// Names of `contact_type`, each also with the ending of [`UPDATED`]: the kind of constraint, and whether contact always slides.
const TYPES: [(&str, MpcKind, bool); 4] = [
    ("Frictionless", MpcKind::Frictionless, false),
    ("Frictional", MpcKind::Frictional, false),
    ("FrictionalPureSlip", MpcKind::Frictional, true),
    ("MeshTying", MpcKind::MeshTying, false),
];
const UPDATED: &str = "WithNormalUpdate";

/// Kind of constraints of `"contact_type"` in these settings, and whether contact always slides.
///
/// # Errors
/// A type that does not exist.
pub fn mpc_contact_type(settings: &Settings) -> Result<(MpcKind, bool)> {
    let name = settings.get_str("contact_type")?;
    let stem = name.strip_suffix(UPDATED).unwrap_or(name);
    if let Some(&(_, kind, pure_slip)) = TYPES.iter().find(|(known, ..)| *known == stem) {
        return Ok((kind, pure_slip));
    }
    let known = TYPES.map(|(known, ..)| known);
    let fact = format!("there is no contact type {name:?} by constraints");
    Err(settings
        .error("contact_type", "contact-type", fact)
        .remedy(did_you_mean(name, known).unwrap_or_else(|| format!("use one of {}", known.join(", "))))
        .into())
}
