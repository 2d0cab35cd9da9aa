//! Steps: time integration, stages, cuts, remedies of Newton's iteration, impacts.

#[path = "../support/boxes.rs"]
mod boxes;
mod explicit_energy;
mod impact;
mod stages;
mod step_cutting;
mod strategies;
#[path = "../support/mod.rs"]
mod support;
mod time_integration;
