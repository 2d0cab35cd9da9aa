//! Contact pairs as blocks: what the search found, in the form the assembly takes.

mod family;
mod pair;
mod pair_block;

pub use family::{Family, Friction, Multiplier, PairRequest, find_family};
pub use pair::{Integral, Pair, PairKey, Previous};
pub use pair_block::{ContactBlock, PairBlock, PairFormulation};
