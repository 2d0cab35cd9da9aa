//! Which facets may touch: a bounding-volume tree over the masters, then a filter on each pair.

mod candidates;
mod reach;
mod tree;

pub use candidates::{Candidate, SearchSettings, candidates};
pub use reach::warn_of_reach;
pub use tree::{Bounds, Tree};
