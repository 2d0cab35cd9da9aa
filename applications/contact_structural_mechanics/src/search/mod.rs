//! Search for facets that may touch: a bounding-volume tree over the masters, then a filter on each pair.

mod along_normals;
mod candidates;
mod direct_check;
mod inside;
mod meetings;
mod missed_pairs_warnings;
mod motion;
mod open_sides;
mod prediction;
mod self_contact;
mod side_order;
mod start;
mod tree;

pub use candidates::{Candidate, GapCheck, SearchDistance, SearchSettings, SetAtStart, WithinStep, candidates};
pub use direct_check::touching_nodes;
pub use inside::inside;
pub(crate) use meetings::FACING;
pub use missed_pairs_warnings::{warn_of_missed_pairs, warn_of_search_radius};
pub use motion::{farthest_motion, have_crossed, step_start};
pub use open_sides::{OpenSides, Renewal};
pub use prediction::predicted_positions;
pub use self_contact::assign_roles;
pub use start::{facing, set_clearance, settle};
pub use tree::{Bounds, Tree};
