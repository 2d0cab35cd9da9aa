//! Work on the pairs of a block by all threads.

use rayon::prelude::*;

/// Pairs that are not worth handing to another thread.
const FEW: usize = 32;

/// What `of` gives for each of `count` pairs, in their order.
///
/// It takes the work as a trait object: blocks are compiled for every family and two shapes, the loop over threads once.
pub(super) fn in_parallel<R: Send>(count: usize, of: &(dyn Fn(usize) -> R + Sync)) -> Vec<R> {
    (0..count).into_par_iter().with_min_len(FEW).map(of).collect()
}
