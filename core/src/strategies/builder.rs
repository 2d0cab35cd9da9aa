//! How an assembled system reaches its linear solver: the builder-and-solver of a deck.
//!
//! Fixities and constraints are always eliminated during assembly. A builder may change the system between assembly and solution, as
//! scaling its rows does, by a solver around the deck's.

use zelus_linear_algebra::LinearSolver;

use crate::diagnostics::Result;
use crate::parameters::Settings;
use crate::{register, registered_kind};

/// Action of a builder.
#[derive(Clone, Copy)]
pub enum BuilderAction {
    /// The system goes to the solver as it is.
    Direct,
    /// A solver around the deck's, which is given with all solver settings.
    Around(fn(&Settings, Box<dyn LinearSolver>) -> Result<Box<dyn LinearSolver>>),
}

registered_kind! {
    /// A builder-and-solver that decks name.
    pub struct BuilderEntry("builder_and_solver", "unknown-name") {
        build: BuilderAction;
    }
}

register! { BuilderEntry "block",
    aliases: &["block_lagrange"],
    about: "fixities and constraints are eliminated; results do not depend on the builder",
    source: "TᵀK T Δ = Tᵀb, eqs. D.12d, D.12e",
    build: BuilderAction::Direct,
}
register! { BuilderEntry "elimination",
    about: "fixities and constraints are eliminated; results do not depend on the builder",
    source: "TᵀK T Δ = Tᵀb, eqs. D.12d, D.12e",
    build: BuilderAction::Direct,
}
