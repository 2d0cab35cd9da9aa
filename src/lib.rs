//! zelus: multiphysics finite elements that run Kratos contact decks unmodified.
//!
//! This crate links the framework and all applications; programs that embed zelus depend on it:
//!
//! ```
//! use zelus::{RunOptions, Silent, Simulation};
//!
//! // A bar of 2 m under a tension of 2 kPa; the run writes no files.
//! let deck = "tests/cases/structural/bar_plane_stress/ProjectParameters.json";
//! let changes = vec![("processes.json_output_process_list".to_owned(), serde_json::json!([]))];
//! let mut simulation = Simulation::open(deck.as_ref(), &RunOptions { changes, ..RunOptions::default() })?;
//! while simulation.step(&mut Silent)? {
//!     println!("time {:?}", simulation.time());
//! }
//! let displacement = simulation.field("DISPLACEMENT").expect("a solver that moves nodes");
//! let largest = displacement.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
//! // σ L/E with E = 2 GPa.
//! assert!((largest / 2e-6 - 1.0).abs() < 1e-12);
//! # Ok::<(), zelus::Error>(())
//! ```
//!
//! A program that adds its own conditions, processes or criteria names their crate and calls [`program::main`]; see
//! `examples/plugin`.

pub mod program;

/// The code of `docs/library.md`, run by the tests.
#[cfg(doctest)]
#[doc = include_str!("../docs/library.md")]
struct Library;

use zelus_constrained_optimization as _;
use zelus_contact_structural_mechanics as _;
use zelus_convection_diffusion as _;
use zelus_meshes as _;
use zelus_structural_mechanics as _;
use zelus_thermal_contact as _;
use zelus_user_materials as _;
use zelus_wear as _;

pub use zelus_constrained_optimization as constrained_optimization;
pub use zelus_contact_structural_mechanics as contact_structural_mechanics;
pub use zelus_convection_diffusion as convection_diffusion;
pub use zelus_core as core;
pub use zelus_core::analysis::{RunOptions, RunReport, Simulation};
pub use zelus_core::strategies::{Monitor, Silent};
pub use zelus_core::{Error, Result};
pub use zelus_meshes as meshes;
pub use zelus_structural_mechanics as structural_mechanics;
pub use zelus_thermal_contact as thermal_contact;
pub use zelus_user_materials as user_materials;
pub use zelus_wear as wear;
