//! Search for facets that may touch: a bounding-volume tree over the masters, then a filter on each pair.

mod along_normals;
mod candidates;
mod direct_check;
mod inside;
mod prediction;
mod reach;
mod self_contact;
mod start;
mod tree;

pub use candidates::{Candidate, GapCheck, SearchDistance, SearchSettings, WithinStep, candidates};
pub use direct_check::touching_nodes;
pub use inside::inside;
pub use prediction::predicted_positions;
pub use reach::{warn_of_late_pairs, warn_of_reach};
pub use self_contact::assign_roles;
pub use start::{facing, settle};
pub use tree::{Bounds, Tree};
