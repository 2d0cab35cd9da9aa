//! Uses that a contact formulation refuses, with reason and remedy: stated once, asked by the processes, walked by a test.

use crate::pairs::{Formulation, Multiplier};

/// Use of a formulation by a deck.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FormulationUse {
    /// Dimensions of the problem.
    pub dimension: usize,
    /// Whether a plane model is rotated about its axis.
    pub axisymmetric: bool,
    /// Whether steps are explicit.
    pub explicit: bool,
    /// Whether the load factor is an unknown.
    pub arc_length: bool,
}

/// Reason why a use is refused, and the replacement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Refusal {
    /// The reason.
    pub reason: &'static str,
    /// The remedy.
    pub remedy: &'static str,
}

/// A rule: its condition, and the refusal.
type Rule = (fn(&Formulation, FormulationUse) -> bool, Refusal);

/// Everything that is not listed runs: every formulation on every pair of shapes, in the plane, in space and (in the plane)
/// about an axis, with every `normal_variation`, law of friction, adaptation of the penalty, strategy and time integration.
const RULES: [Rule; 4] = [
    (
        |_, wanted| wanted.axisymmetric && wanted.dimension == 3,
        Refusal {
            reason: "a model in space has no axis to be rotated about",
            remedy: "set \"axisymmetric\" to false, or \"domain_size\" to 2",
        },
    ),
    (
        |formulation, wanted| {
            wanted.explicit && matches!(formulation.multiplier, Multiplier::Scalar(_) | Multiplier::Vector(_))
        },
        Refusal {
            reason: "explicit steps give every unknown a mass, and multipliers have none",
            remedy: "use explicit_penalty_contact_process with \"mortar_type\": \"PenaltyContactFrictionless\"",
        },
    ),
    (
        |formulation, wanted| wanted.explicit && matches!(formulation.multiplier, Multiplier::Body),
        Refusal {
            reason: "explicit steps do not iterate, and tractions of bodies follow from the displacements of the step",
            remedy: "use explicit_penalty_contact_process with \"mortar_type\": \"PenaltyContactFrictionless\"",
        },
    ),
    (
        |formulation, wanted| wanted.arc_length && formulation.updated,
        Refusal {
            reason: "an outer loop would go along the path with every update of the multipliers",
            remedy: "use alm_contact_process, or \"solving_strategy_settings\" of the type \"newton_raphson\"",
        },
    ),
];

/// The first reason not to use a formulation so.
pub fn refusal(formulation: &Formulation, wanted: FormulationUse) -> Option<Refusal> {
    RULES.iter().find(|(applies, _)| applies(formulation, wanted)).map(|(_, refusal)| *refusal)
}
