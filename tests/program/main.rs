//! The program as users meet it: its commands, words, files, pages and ways in.

mod bad_decks;
#[path = "../support/blocks.rs"]
mod blocks;
mod builders;
mod command_line;
mod compatibility;
mod diff;
#[path = "../../fuzz/src/forge.rs"]
mod forge;
mod fit;
mod forged;
mod meshes;
mod modelers;
mod new_user;
mod nothing_lost;
mod page;
mod picture;
mod pyramids_and_prisms;
mod ranks_as_threads;
mod registry;
#[path = "../support/renumber.rs"]
mod renumber;
mod resume;
mod robustness;
mod saved;
mod schema;
mod set;
mod simulation;
mod soundness;
#[path = "../support/mod.rs"]
mod support;
mod sweep;
mod terminal;
#[path = "../support/thread_ranks.rs"]
mod thread_ranks;
mod usual_results;
