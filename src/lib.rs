//! zelus: multiphysics finite elements that run Kratos contact decks unmodified.
//!
//! This crate links the framework and all applications, and is what programs that embed zelus depend on:
//!
//! ```no_run
//! use zelus::{RunOptions, Silent};
//! let (result, report) = zelus::run("ProjectParameters.json".as_ref(), &RunOptions::default(), &mut Silent);
//! result.unwrap();
//! println!("{} steps", report.steps.len());
//! ```
//!
//! A program that adds its own conditions, processes or criteria names their crate and calls [`program::main`]; see
//! `examples/plugin`.

pub mod program;

use zelus_constrained_optimization as _;
use zelus_contact_structural_mechanics as _;
use zelus_structural_mechanics as _;

pub use zelus_constrained_optimization as constrained_optimization;
pub use zelus_contact_structural_mechanics as contact_structural_mechanics;
pub use zelus_core as core;
pub use zelus_core::analysis::{RunOptions, RunReport, check, run};
pub use zelus_core::strategies::{Monitor, Silent};
pub use zelus_core::{Error, Result};
pub use zelus_structural_mechanics as structural_mechanics;
