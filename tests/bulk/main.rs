//! Bodies against closed forms and published values: elasticity, convergence, large strains, plasticity, springs.
//!
//! Each test builds its mesh, writes a deck as a user would, runs it and compares. Every reference is ANALYTIC unless the
//! test says otherwise; the tolerance stands with its reason.

mod bolts;
mod convergence;
mod couplings;
mod creep;
mod cup;
mod deck;
mod elastic;
mod grid;
mod large_strain;
mod law_functions;
mod mean_rotations;
mod orthotropic;
mod periodic;
mod plastic;
mod resultants;
mod rigid_bodies;
mod rigid_shapes;
mod rigid_shapes_in_runs;
mod rubber;
mod rubber_roller;
mod springs;
mod stress_results;
mod supports;
#[path = "../support/thread_ranks.rs"]
mod thread_ranks;
mod user_materials;
