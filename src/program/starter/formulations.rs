//! Formulations of contact that `zelus new` writes by name.

use zelus_core::Result;
use zelus_core::diagnostics::{Diagnostic, did_you_mean};

/// A formulation: process, beginning of the mortar type, and whether it has friction and stands beside ties.
#[derive(Debug, Clone, Copy)]
pub(super) struct Formulation {
    name: &'static str,
    pub process: &'static str,
    /// None where constraints take the place of multipliers.
    pub mortar: Option<&'static str>,
    has_friction: bool,
}

/// All of them; the first is that of decks without a name.
const KNOWN: [Formulation; 6] = [
    Formulation { name: "alm", process: "alm_contact_process", mortar: Some("ALMContact"), has_friction: true },
    Formulation {
        name: "penalty",
        process: "penalty_contact_process",
        mortar: Some("PenaltyContact"),
        has_friction: true,
    },
    Formulation { name: "uzawa", process: "uzawa_contact_process", mortar: Some("UzawaContact"), has_friction: false },
    Formulation {
        name: "perturbed_lagrangian",
        process: "perturbed_lagrangian_contact_process",
        mortar: Some("PerturbedLagrangianContact"),
        has_friction: false,
    },
    Formulation {
        name: "nitsche",
        process: "nitsche_contact_process",
        mortar: Some("NitscheContact"),
        has_friction: true,
    },
    Formulation { name: "mpc", process: "mpc_contact_process", mortar: None, has_friction: true },
];

impl Formulation {
    /// The formulation of this name, for a deck with or without friction, and with or without ties.
    ///
    /// # Errors
    /// A name that is not known, or a formulation that does not go with the deck.
    pub(super) fn find(name: &str, friction: bool, ties: bool) -> Result<Self> {
        let wrong = |fact: String, remedy: String| {
            zelus_core::Error::from(Diagnostic::error("command-line", format!("--formulation {fact}")).remedy(remedy))
        };
        let names = KNOWN.map(|own| own.name);
        let Some(found) = KNOWN.into_iter().find(|own| own.name == name) else {
            let remedy = did_you_mean(name, names).unwrap_or_else(|| format!("formulations: {}", names.join(", ")));
            return Err(wrong(format!("{name}: there is no such formulation"), remedy));
        };
        if friction && !found.has_friction {
            let others: Vec<&str> = KNOWN.iter().filter(|own| own.has_friction).map(|own| own.name).collect();
            return Err(wrong(format!("{name}: it has no friction"), format!("with friction: {}", others.join(", "))));
        }
        if ties && found.name != KNOWN[0].name {
            let remedy = format!("leave the option out, or name {}", KNOWN[0].name);
            return Err(wrong(
                format!("{name}: beside ties and NO SEPARATION a deck of `zelus new` has {} alone", KNOWN[0].name),
                remedy,
            ));
        }
        Ok(found)
    }
}

impl Default for Formulation {
    fn default() -> Self {
        KNOWN[0]
    }
}
