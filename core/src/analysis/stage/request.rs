//! The input of a stage's preparation.

use std::path::PathBuf;

use super::super::deck::{Folders, StageDeck};
use crate::processes::Process;

/// A stage to prepare, as the caller of a simulation states it.
pub(in crate::analysis) struct StageRequest<'a> {
    /// The stage, and those of the deck after it.
    pub stages: &'a [StageDeck],
    /// Folders in which names of files begin.
    pub folders: &'a Folders,
    /// Program whose defaults hold where the deck names nothing.
    pub like: Option<&'a str>,
    /// Processes that act after those of the deck.
    pub more: Vec<Box<dyn Process>>,
    /// Files that the caller will write.
    pub outputs: &'a [PathBuf],
}
