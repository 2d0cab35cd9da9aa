//! The kinds of this crate keep the promises of all registered kinds.

use zelus_plugin as _;

#[path = "../../../tests/registry_walk.rs"]
mod registry_walk;
