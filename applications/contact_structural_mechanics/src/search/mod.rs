//! Which facets may touch: a bounding-volume tree over the masters, then a filter on each pair.

mod candidates;
mod tree;

pub use candidates::{Candidate, SearchSettings, candidates};
pub use tree::{Bounds, Tree};
