//! Heat: conduction, convection by a given velocity, storage, and exchange with the surroundings.
//!
//! [`elements`] integrate the balance of heat over a body, [`conditions`] over its boundary; [`solvers`] march it through
//! time. Everything registers itself by the name Kratos gives it. A module uses only those above it in the list below.

pub mod variables;
pub mod columns;
pub mod coefficient;
pub mod material;
pub mod elements;
pub mod conditions;
mod processes;
pub mod scheme;
pub mod transport;
pub mod semi_implicit;
mod runge_kutta;
pub mod adoption;
mod plastic_heat;
mod heat;
mod staggered;
mod monolithic;
pub mod coupling_settings;
pub mod coupling;
pub mod solvers;
