//! The stage loop: from a deck to results.
//!
//! A stage holds the system of one model part, a strategy and processes.
//!
//! [`run`] reads `ProjectParameters.json` and runs its stage, or, in the form with an orchestrator, its stages one after
//! another on one model. [`check`] does everything that can be done without solving.

mod cutting;
mod deck;
mod like;
mod mesh;
mod older_decks;
mod orchestrator;
mod report;
mod saved;
mod sharing;
mod solver;
mod stage;
mod time_stepping;

pub use cutting::Cutting;
pub use mesh::{DeckMesh, read_deck_mesh};
pub use orchestrator::{RunOptions, check, run};
pub use report::{RunReport, Sizes};
pub use solver::{EXPLICIT, ExtensionDefinition, NodalVariable, SolverDefinition, SolverEntry, SolverExtensionEntry};
pub use time_stepping::TimeStepping;
