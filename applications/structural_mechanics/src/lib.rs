//! Structural mechanics: constitutive laws, solid elements, load conditions, and the solvers of structural problems.
//!
//! [`laws`] turn strain into stress; [`elements`] integrate it over a body; [`conditions`] load its boundary. Everything
//! registers itself by the name Kratos gives it. A module uses only those above it in the list below.

pub mod variables;
pub mod tensor;
pub mod laws;
pub mod stress_invariant;
pub mod elements;
pub mod conditions;
pub mod rigid_shapes;
mod processes;
pub mod solvers;
#[cfg(test)]
mod test_model;
