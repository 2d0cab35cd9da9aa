//! Structural mechanics: constitutive laws, solid elements, load conditions, and the solvers of structural problems.
//!
//! [`laws`] turn strain into stress; [`elements`] integrate it over a body; [`conditions`] load its boundary. Everything
//! registers itself by the name Kratos gives it.

pub mod conditions;
pub mod elements;
pub mod laws;
mod processes;
mod solvers;
pub mod tensor;
#[cfg(test)]
mod test_model;
pub mod variables;
