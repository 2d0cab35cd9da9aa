//! Processes: what a deck does at fixed points of the stage loop.

mod process;

pub use process::{Process, ProcessFactory, ProcessRequest};
