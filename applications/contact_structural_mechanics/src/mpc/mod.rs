//! Contact and ties by linear constraints.

mod mpc_contact_settings;
mod mpc_edges;
mod mpc_friction;
mod mpc_impact;
mod mpc_interaction;
mod mpc_kind;
mod mpc_results;
mod mpc_settings;
mod node_relation;
mod relations;
mod slider_forces;

pub use mpc_contact_settings::updates_each_iteration;
pub use mpc_interaction::MpcInteraction;
pub use mpc_kind::{MpcKind, mpc_contact_type};
pub use mpc_settings::MpcSettings;
pub use node_relation::Weights;
