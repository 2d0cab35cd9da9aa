//! Constrained optimisation: springs, walls, and every method that keeps the ones off the others.
//!
//! A problem is min f(x) subject to g(x) ≥ 0. [`springs`] are the elements that add up to f; [`constraints`] are the
//! conditions that say g. Neither knows how g is imposed: that is the [`method`], one file of [`methods`] and one process
//! of the deck each. A method adds a term ℓ(g, λ) to the functional and gives its first derivatives; a block of
//! [`constraint_block`] makes residual and tangent of it, and the interaction of [`constraint_interaction`] decides in
//! every iteration which constraints act ([`active_set`]). The framework does the rest as for any other problem.
//!
//! A module uses only those above it in the list below.
//!
//! Signs: g < 0 is penetration and λ < 0 pressure, as in contact. The printed equations D.13–D.21 change signs between
//! text and tables (`u + 0.9 ≤ 0` where the iterates keep u + 0.9 ≥ 0; λ = 1 in Tables D.4–D.6 where D.8 has
//! λ = −0.001); the iterates of the tables decide. A constraint that is written as g ≤ 0 has a multiplier λ ≥ 0.

pub mod active_set;
pub mod variables;
pub mod springs;
pub mod constraints;
pub mod method;
pub mod constraint_block;
pub mod constraint_interaction;
pub mod methods;
mod iterate_output_process;
mod optimality_criterion;
mod solver;
