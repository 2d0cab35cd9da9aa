//! The stage loop: from a deck to results.
//!
//! A stage holds the system of one model part, a strategy and processes.
//!
//! A [`Simulation`] reads `ProjectParameters.json` and makes the steps of its stage, or, in the form with an orchestrator, of its
//! stages one after another on one model.

mod rigid_body_modes;
mod body_loads;
mod checkpoints;
mod coincident_nodes;
mod contents;
mod cutting;
mod deck;
mod driver;
mod large_motion;
mod loose_loads;
mod program_defaults;
mod mesh;
mod no_load;
mod older_decks;
mod rank_layout;
mod repartitioning;
mod report;
mod step_backup;
mod saved_run;
mod sharing;
mod model_checks;
mod simulation;
mod solver;
mod stage;
mod threads;
mod time_stepping;
#[cfg(test)]
mod two_walls_tests;
mod unresisted_loads;
mod unused_settings;

pub use cutting::Cutting;
pub use driver::{Driver, LoopPoint, Unattended};
pub use mesh::{DeckMesh, read_deck_mesh};
pub use report::{Body, NodePlace, RunReport, Sizes};
pub use simulation::{RunOptions, Simulation};
pub use solver::{
    ExtensionDefinition, NodalVariable, SolverDefinition, SolverEntry, SolverExtensionEntry, SolverSettings,
};
pub use time_stepping::TimeStepping;
